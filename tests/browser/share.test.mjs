// A link carries the whole model; a bad one never costs the model that is there.

import assert from "node:assert/strict";
import { test } from "node:test";
import { deflateSync, inflateSync } from "node:zlib";
import { assertOnCanvas, atRest, documentOf, point, wide } from "./support/model.mjs";
import { inspect, open, untilInspect, withPage } from "./support/page.mjs";
import { drag } from "./support/pointer.mjs";

const context = { permissions: ["clipboard-read", "clipboard-write"] };
const limit = 4 << 20;

const disc = {
  ductile: 1,
  name: "From an address",
  points: { 1: [1, 0, 0], 2: [0, 1, 0], 3: [-1, 0, 0], 4: [0, -1, 0.5] },
  curves: { 1: { through: [1, 2, 3, 4], closed: true } },
};

test("the link of an edited model opens the same model elsewhere", async () => {
  const session = await open({ viewport: wide, context });
  try {
    const { page, server } = session;
    const sent = await edited(page);
    await page.locator("#link").click();
    const told = await untilInspect(page, (state) => state.toast?.startsWith("Link copied"));
    const link = await page.evaluate(() => navigator.clipboard.readText());
    assert.ok(link.startsWith(`${server.url}#d1=`), link);
    assert.ok(told.toast.includes(`${link.length} characters`), told.toast);
    assert.ok(told.toast.includes("7 points, 1 curve and 1 surface"), told.toast);
    assert.ok(link.length < 2000, "a model of this size fits in a chat");

    const other = await session.browser.newContext({ viewport: wide });
    const friend = await session.visit(link, other);
    const seen = await atRest(friend);
    assert.equal(seen.document, sent.document, "the documents are equal");
    const ratio = seen.figures.energy / sent.figures.energy;
    assert.ok(Math.abs(ratio - 1) < 0.02, `the energies are equal but for ${ratio}`);
    assert.deepEqual(seen.banners, []);
    assert.deepEqual(seen.points.map(({ id, role, at }) => [id, role, at]), sent.points.map(({ id, role, at }) => [id, role, at]));
    assert.ok(!server.requests.some((path) => path.includes("d1=")), "the model was never sent to the server");

    // After the first act of the friend, the address no longer promises what is on the screen.
    assert.ok((await friend.evaluate(() => location.hash)).startsWith("#d1="));
    await edited(friend);
    assert.equal(await friend.evaluate(() => location.hash), "");
    session.assertQuiet();
  } finally {
    await session.close();
  }
});

test("without the clipboard the link can be copied by hand", async () => {
  // No permission: Chromium refuses to write.
  await withPage({ viewport: wide }, async (page) => {
    const before = await atRest(page);
    await page.evaluate(() => {
      Object.defineProperty(navigator.clipboard, "writeText", { value: () => Promise.reject(new Error("refused")) });
    });
    await page.keyboard.press("Control+Shift+C");
    const field = page.locator("#link-field");
    await field.waitFor({ state: "visible", timeout: 60_000 });
    const link = await field.inputValue();
    const text = inflateSync(Buffer.from(link.split("#d1=")[1], "base64url")).toString();
    assert.deepEqual(JSON.parse(text), JSON.parse(before.document), "the link holds the document");
    assert.equal(await page.evaluate(() => document.activeElement.id), "link-field");
    await page.keyboard.press("Escape");
    await field.waitFor({ state: "hidden" });
  });
});

const whole = `#d1=${pack(JSON.stringify(disc))}`;
const broken = {
  "a link with letters that no link has": ["#d1=!!!not-a-link!!!", /this link is damaged/i],
  "a truncated link": [whole.slice(0, -20), /this link is damaged/i],
  "a link of a newer version": ["#d2=abcdef", /newer Ductile/],
  "a document of a newer version": [`#d1=${pack(JSON.stringify({ ...disc, ductile: 99 }))}`, /newer|version/i],
  "a link without JSON": [`#d1=${pack("hello")}`, /line 1|expected|JSON/i],
  "a link that would fill the memory": [`#d1=${pack(Buffer.alloc(64 << 20))}`, /more than any document holds/],
};

for (const [what, [hash, message]] of Object.entries(broken)) {
  test(`${what} opens with a message, and the page works`, async () => {
    await withPage({ viewport: wide, hash }, async (page) => {
      const state = await atRest(page);
      assert.equal(state.banners.length, 1);
      assert.match(state.banners[0], message);
      assert.equal(state.name, "Raised disc", "something is there to work with");
      await page.locator('[data-command="dismiss"]').click();
      await untilInspect(page, ({ banners }) => banners.length === 0);
      await edited(page);
    });
  });
}

test("bad links pasted into the address leave the model as it is; a good one opens and can be undone", async () => {
  await withPage({ viewport: wide }, async (page) => {
    const before = await edited(page);
    for (const [what, [hash, message]] of Object.entries(broken)) {
      await page.evaluate((wanted) => (location.hash = wanted), hash);
      const state = await atRest(page, ({ banners }) => banners.some((text) => message.test(text)));
      assert.equal(state.document, before.document, what);
      assert.equal(state.figures.energy, before.figures.energy, what);
      assert.equal(state.openings, before.openings, what);
      assert.match(state.banners.join(), /The model on the screen is as it was/, what);
      await page.locator('[data-command="dismiss"]').click();
    }
    await page.evaluate((wanted) => (location.hash = wanted), whole);
    const opened = await atRest(page, ({ name }) => name === disc.name);
    assert.deepEqual(JSON.parse(opened.document).points, disc.points);
    assert.deepEqual(opened.banners, []);
    await page.keyboard.press("Control+z");
    const back = await atRest(page, ({ name }) => name !== disc.name);
    assert.equal(back.document, before.document, "opening can be undone");
  });
});

test("?spec= opens a file of the server", async () => {
  const extra = { "/models/a disc.json": { type: "application/json", body: JSON.stringify(disc) } };
  await withPage({ viewport: wide, extra, query: "?spec=models%2Fa+disc.json" }, async (page) => {
    const state = await atRest(page);
    const { points, curves, name } = JSON.parse(state.document);
    assert.deepEqual({ points, curves, name }, { points: disc.points, curves: disc.curves, name: disc.name });
    assert.deepEqual(state.banners, []);
    assert.equal(state.curves.length, 1);
  });
});

const refused = {
  "a missing file": { query: "?spec=nothing.json", message: /nothing\.json was not opened.*404/, allow: /404/ },
  "a file that is no JSON": {
    extra: { "/page.json": { type: "text/html", body: "<!doctype html><title>Hello</title>" } },
    query: "?spec=page.json",
    message: /line 1/,
  },
  "a file that is cut off": {
    extra: { "/cut.json": { type: "application/json", body: JSON.stringify(disc, null, 1).slice(0, 60) } },
    query: "?spec=cut.json",
    message: /line \d+/,
  },
  "a file that is too large": {
    extra: { "/large.json": { type: "application/json", body: JSON.stringify(disc) + " ".repeat(limit) } },
    query: "?spec=large.json",
    message: new RegExp(`larger than ${limit} bytes`),
  },
};

for (const [what, { message, ...options }] of Object.entries(refused)) {
  test(`?spec= with ${what} says so, and the page works`, async () => {
    await withPage({ viewport: wide, ...options }, async (page) => {
      const state = await atRest(page, ({ banners }) => banners.length > 0);
      assert.match(state.banners.join(), message);
      assert.equal(state.banners.length, 1);
      assert.equal(state.name, "Raised disc");
      await edited(page);
    });
  });
}

/** Pulls point 7 up a little and waits until the shape rests. */
async function edited(page) {
  const before = await atRest(page);
  const from = point(before, 7).screen;
  const to = [from[0] + 6, from[1] - 40];
  await assertOnCanvas(page, from, to);
  await drag(page, from, to);
  const after = await atRest(page, (state) => state.document !== before.document);
  assert.notDeepEqual((await documentOf(page)).points[7], JSON.parse(before.document).points[7]);
  assert.equal((await inspect(page)).undo, after.undo);
  return after;
}

function pack(content) {
  return deflateSync(content).toString("base64url");
}
