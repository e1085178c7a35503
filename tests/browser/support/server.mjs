// A static file server for the built page, as a careful host would set it up.

import { createHash } from "node:crypto";
import { readFile } from "node:fs/promises";
import { createServer } from "node:http";
import { extname, join, normalize, resolve, sep } from "node:path";
import { fileURLToPath } from "node:url";

const top = fileURLToPath(new URL("../../..", import.meta.url));

/** The folder of the page under test: what `cargo xtask test` has built. */
export const pageFolder = process.env.DUCTILE_PAGE ?? join(top, "dist-test");

const types = {
  ".css": "text/css; charset=utf-8",
  ".html": "text/html; charset=utf-8",
  ".ico": "image/x-icon",
  ".js": "text/javascript; charset=utf-8",
  ".json": "application/json",
  ".png": "image/png",
  ".svg": "image/svg+xml",
  ".wasm": "application/wasm",
  ".webmanifest": "application/manifest+json",
  ".woff2": "font/woff2",
};

/**
 * Serves `folder` on a free port. `extra` maps paths such as `/spec.json` to `{ type, body }` (or to a function of the
 * request that returns this, or null for 404): documents that a test loads from an address.
 */
export async function serve(folder = pageFolder, extra = {}) {
  const policy = contentSecurityPolicy(await readFile(join(folder, "index.html"), "utf8"));
  const headers = {
    "content-security-policy": policy,
    "cross-origin-opener-policy": "same-origin",
    "cross-origin-embedder-policy": "require-corp",
    "cross-origin-resource-policy": "same-origin",
    "referrer-policy": "no-referrer",
    "x-content-type-options": "nosniff",
    // The worker's files have no hash in their names.
    "cache-control": "no-cache",
  };
  const requests = [];
  const server = createServer(async (request, response) => {
    const path = decodeURIComponent(new URL(request.url, "http://page").pathname);
    requests.push(path);
    const found = path in extra ? await answer(extra[path], request) : await file(folder, path);
    response.writeHead(found ? 200 : 404, { ...headers, "content-type": found?.type ?? "text/plain" });
    response.end(found?.body ?? "not found");
  });
  await new Promise((ready) => server.listen(0, "127.0.0.1", ready));
  return {
    url: `http://127.0.0.1:${server.address().port}/`,
    /** Every path that was asked for, in order. */
    requests,
    close() {
      server.closeAllConnections();
      return new Promise((closed) => server.close(closed));
    },
  };
}

async function answer(entry, request) {
  return typeof entry === "function" ? entry(request) : entry;
}

async function file(folder, path) {
  const base = resolve(folder);
  const full = join(base, normalize(path.endsWith("/") ? `${path}index.html` : path));
  if (!full.startsWith(base + sep)) return null;
  try {
    return { body: await readFile(full), type: types[extname(full)] ?? "application/octet-stream" };
  } catch {
    return null;
  }
}

/**
 * The strictest policy under which the page must work. Trunk starts the program from a script inside the page, whose
 * text contains the hashed file names: it is admitted by its digest, as a host would have to do.
 */
export function contentSecurityPolicy(html) {
  const inline = [...html.matchAll(/<script(?![^>]*\bsrc=)[^>]*>([\s\S]*?)<\/script>/g)];
  const digests = inline.map(([, text]) => `'sha256-${createHash("sha256").update(text).digest("base64")}'`);
  return [
    "default-src 'none'",
    ["script-src 'self' 'wasm-unsafe-eval'", ...digests].join(" "),
    "worker-src 'self'",
    "connect-src 'self'",
    "style-src 'self'",
    "img-src 'self' data: blob:",
    "manifest-src 'self'",
    "base-uri 'none'",
    "form-action 'none'",
    "frame-ancestors 'none'",
    "require-trusted-types-for 'script'",
  ].join("; ");
}
