// Opens the page and watches it: whatever it complains of, and whatever it asks of a stranger, fails the test.

import assert from "node:assert/strict";
import { launch } from "./browser.mjs";
import { serve } from "./server.mjs";

/**
 * Runs `body` with an opened page and closes everything after it. The test fails on any console error or warning, any
 * uncaught error and any request to another origin that `options.allow` (a regular expression on the text) does not cover.
 *
 * Options: `viewport` (640 × 400: software rendering is slow, keep it small), `hash` (of the address, with `#`),
 * `query` (with `?`), `extra` (see `serve`), `context` (more options of Playwright's `newContext`), `allow`,
 * `settle` (false: do not wait for the program to start), `flags` (more of them for the browser), `webgpu` (false: a
 * browser without it), `init` (a function that runs in every page before its own program).
 */
export async function withPage(options, body) {
  const session = await open(options);
  try {
    await body(session.page, session);
    session.assertQuiet();
  } finally {
    await session.close();
  }
}

/** As `withPage`, for tests that need more than one page; close the session yourself. */
export async function open(options = {}) {
  const server = await serve(undefined, options.extra);
  const browser = await launch({ more: options.flags, webgpu: options.webgpu });
  const viewport = options.viewport ?? { width: 640, height: 400 };
  const context = await browser.newContext({ viewport, ...options.context });
  if (options.init) await context.addInitScript(options.init);
  const session = {
    browser,
    context,
    server,
    complaints: [],
    /** Opens another page, in the same context or in one of its own. */
    async visit(address = "", place = context) {
      const page = await place.newPage();
      watch(page, server.url, session.complaints);
      await page.goto(new URL(address, server.url).href);
      if (options.settle !== false) await started(page);
      return page;
    },
    assertQuiet() {
      const unexpected = session.complaints.filter((text) => !options.allow?.test(text));
      assert.deepEqual(unexpected, [], "the page complained");
    },
    async close() {
      await browser.close();
      await server.close();
    },
  };
  try {
    session.page = await session.visit(`${options.query ?? ""}${options.hash ?? ""}`);
  } catch (error) {
    await session.close();
    const context = session.complaints.map((text) => `\n  ${text}`).join("");
    throw new Error(`the page did not open: ${error.message}${context}`, { cause: error });
  }
  return session;
}

/** Records what the page complains of. Reports of the content security policy arrive as console errors. */
function watch(page, home, complaints) {
  page.on("console", (message) => {
    if (["error", "warning"].includes(message.type())) complaints.push(`console ${message.type()}: ${message.text()}`);
  });
  page.on("pageerror", (error) => complaints.push(`uncaught: ${error.stack ?? error}`));
  page.on("crash", () => complaints.push("the page crashed"));
  page.on("request", (request) => {
    const url = request.url();
    if (!url.startsWith(home) && !/^(data|blob):/.test(url)) complaints.push(`foreign request: ${url}`);
  });
  page.on("response", (response) => {
    if (response.status() >= 400) complaints.push(`status ${response.status()}: ${response.url()}`);
  });
}

/** Waits until the program has been loaded and its inspection function answers. */
export async function started(page, { timeout = 60_000 } = {}) {
  await untilInspect(page, (state) => state !== null, { timeout });
}

/** What the program says of itself, or null while it is not running yet. */
export function inspect(page) {
  return page.evaluate(() => JSON.parse(window.wasmBindings?.inspect() || "null"));
}

/** Brings trouble about: `lose-device`, `kill-worker`, `hang-worker` or `trap-worker` (a panic inside of it). */
export function provoke(page, what) {
  return page.evaluate((word) => window.wasmBindings.provoke(word), what);
}

/**
 * Polls until `predicate(argument)` holds in the page. Playwright's own `waitForFunction` needs `eval`, which the
 * page's content security policy forbids.
 */
export async function until(page, predicate, argument, { timeout = 60_000 } = {}) {
  const deadline = Date.now() + timeout;
  for (;;) {
    if (await page.evaluate(predicate, argument)) return;
    if (Date.now() > deadline) throw new Error(`waited ${timeout} ms in vain for ${predicate}`);
    await page.waitForTimeout(50);
  }
}

/** Polls `inspect` until `predicate` holds for what it says; returns that. */
export async function untilInspect(page, predicate, { timeout = 60_000 } = {}) {
  const deadline = Date.now() + timeout;
  for (;;) {
    const state = await inspect(page);
    if (predicate(state)) return state;
    if (Date.now() > deadline) {
      throw new Error(`waited ${timeout} ms in vain for ${predicate}; the program says ${JSON.stringify(state)}`);
    }
    await page.waitForTimeout(50);
  }
}
