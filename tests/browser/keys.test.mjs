// The list of keys: what it says, and how a designer changes it. `PICTURES=folder` keeps the pictures.

import assert from "node:assert/strict";
import { test } from "node:test";
import { atRest, wide } from "./support/model.mjs";
import { started, until, untilInspect, withPage } from "./support/page.mjs";

const size = { width: 1280, height: 800 };
const keyOf = (meaning) => `#keys dt button.key[data-subject="${meaning}"] kbd`;
const shows = (page, selector, text) =>
  until(page, ([selector, text]) => document.querySelector(selector).textContent === text, [selector, text], { timeout: 5000 });
const notes = (page, pattern) =>
  until(page, (pattern) => new RegExp(pattern).test(document.getElementById("keys-note").textContent), pattern, { timeout: 5000 });
const inHand = (page, tool) => until(page, (tool) => JSON.parse(window.wasmBindings.inspect()).tool === tool, tool, { timeout: 5000 });
const photo = async (page, name) => {
  if (process.env.PICTURES) await page.screenshot({ path: `${process.env.PICTURES}/${name}.png` });
};

/** Clicks a key of the list, then presses another. */
async function change(page, meaning, key) {
  await page.locator(keyOf(meaning)).click();
  await notes(page, "^Press the new key");
  await page.keyboard.press(key);
}

test("every tool has the key that its tip, the list and the design say", async () => {
  const keys = { shape: "v", point: "p", curve: "c", draw: "d", sheet: "s", sweep: "w", embed: "i", burnout: "b", crease: "k",
    split: "x", glue: "g", merge: "m", trim: "t", ribbon: "r", fill: "f", cage: "q", displace: "e", shadow: "l" };
  await withPage({ viewport: wide }, async (page) => {
    await atRest(page);
    for (const [tool, key] of Object.entries(keys)) {
      await page.keyboard.press("v");
      await page.keyboard.press(key);
      await inHand(page, tool);
      assert.equal(await page.locator(`#tool-${tool} kbd`).textContent(), key.toUpperCase());
      assert.ok((await page.locator(keyOf(key)).count()) > 0, `the list has ${key}`);
    }
    // O is kept for cylinders and spheres.
    await page.keyboard.press("v");
    await page.keyboard.press("o");
    await page.keyboard.press("p");
    await inHand(page, "point");
  });
});

test("a tool, a view and undo get other keys; the old ones mean nothing; all is kept for the next visit", async () => {
  await withPage({ viewport: wide }, async (page) => {
    const before = await atRest(page);
    await page.keyboard.press("?");
    await notes(page, "can be changed");
    await change(page, "w", "n");
    await notes(page, "^N it is");
    await change(page, "7", "8");
    await change(page, "ctrl+z", "Control+u");
    await notes(page, "^Ctrl U it is");
    await shows(page, keyOf("w"), "N");
    await shows(page, "#tool-sweep kbd", "N");
    await shows(page, "#undo kbd", "Ctrl U");
    await page.keyboard.press("Escape");
    await page.locator("#keys").waitFor({ state: "hidden" });

    await page.keyboard.press("w");
    await page.keyboard.press("p");
    await inHand(page, "point");
    await page.keyboard.press("n");
    await inHand(page, "sweep");
    await page.keyboard.press("Escape");
    await page.keyboard.press("8");
    await untilInspect(page, ({ camera }) => camera.forward[2] < -0.99);

    // Something to undo: a point is released.
    await page.locator("#view").focus();
    await page.keyboard.press("Tab");
    await page.keyboard.press("ArrowUp");
    const moved = await atRest(page, (state) => state.document !== before.document);
    await page.keyboard.press("Control+z");
    await page.keyboard.press("Control+u");
    const back = await atRest(page, (state) => state.document !== moved.document);
    assert.equal(back.document, before.document, "undone once, by the new key alone");

    await page.reload();
    await started(page);
    await shows(page, "#tool-sweep kbd", "N");
    await page.keyboard.press("n");
    await inHand(page, "sweep");
    await page.keyboard.press("?");
    await page.locator("#keys-reset").click();
    await shows(page, keyOf("w"), "W");
    await shows(page, "#undo kbd", "Ctrl Z");
    await page.locator("#keys-reset").waitFor({ state: "hidden" });
    await page.keyboard.press("Escape");
    await page.locator("#keys").waitFor({ state: "hidden" });
    await page.keyboard.press("Escape");
    await page.keyboard.press("w");
    await inHand(page, "sweep");
  });
});

test("a key that is taken or needed is refused with its name, Esc leaves it, and two can change places by a third", async () => {
  for (const colorScheme of ["light", "dark"]) {
    await withPage({ viewport: size, context: { colorScheme } }, async (page) => {
      await atRest(page);
      await page.locator("#help").click();
      await photo(page, `keys-${colorScheme}`);
      await change(page, "w", "s");
      await notes(page, "^S is already the key of Sheet");
      await photo(page, `keys-refused-${colorScheme}`);
      await page.keyboard.press("ArrowLeft");
      await notes(page, "needed everywhere");
      await page.keyboard.press("Shift");
      await notes(page, "needed everywhere");
      await page.keyboard.press("Escape");
      await notes(page, "can be changed");
      await page.locator("#keys").waitFor({ state: "visible" });
      await shows(page, keyOf("w"), "W");
      await change(page, "w", "n");
      await change(page, "s", "w");
      await change(page, "w", "s");
      await notes(page, "^S it is");
      await photo(page, `keys-changed-${colorScheme}`);
      await page.keyboard.press("Escape");
      await page.keyboard.press("w");
      await inHand(page, "sheet");
      await page.keyboard.press("s");
      await inHand(page, "sweep");
    });
  }
});
