// How long edges are, in the properties: for the document, a surface and a region of it.

import assert from "node:assert/strict";
import { test } from "node:test";
import { atRest, documentOf, pulled, wide } from "./support/model.mjs";
import { until, withPage } from "./support/page.mjs";

/** Waits until a select or a field shows a value. */
function shows(page, id, value) {
  return until(page, ([id, value]) => document.getElementById(id).checkVisibility() && document.getElementById(id).value === value, [id, value], { timeout: 5000 });
}

test("density by curvature takes fewer nodes, is undone, and travels with the document", async () => {
  await withPage({ viewport: wide }, async (page) => {
    const before = await pulled(page);
    await page.locator("#view").focus();
    await page.keyboard.press("Escape");
    await shows(page, "density", "0");
    await page.locator("#density").selectOption({ label: "By curvature" });
    const dense = await atRest(page, (state) => state.document !== before.document);
    assert.equal((await documentOf(page)).density, "curvature");
    assert.equal(dense.act, "Density");
    assert.ok(dense.figures.nodes < 0.75 * before.figures.nodes, `${before.figures.nodes} nodes became ${dense.figures.nodes}`);
    await shows(page, "density", "1");
    await page.locator("#view").focus();
    await page.keyboard.press("Control+z");
    const after = await atRest(page, (state) => state.document === before.document);
    assert.equal(after.figures.nodes, before.figures.nodes);
    await shows(page, "density", "0");
  });
});

test("a surface has an edge length and a density of its own until it follows the document again", async () => {
  await withPage({ viewport: wide }, async (page) => {
    const before = await atRest(page);
    await page.locator('#scene-list [data-subject="surface 1"]').click();
    await shows(page, "density", "");
    await shows(page, "spacing", "");
    await page.locator("#spacing").fill("0.2");
    await page.locator("#spacing").press("Enter");
    const coarse = await atRest(page, (state) => state.document !== before.document);
    assert.equal((await documentOf(page)).surfaces[1].spacing, 0.2);
    assert.ok(coarse.figures.nodes < 0.4 * before.figures.nodes, `${before.figures.nodes} nodes became ${coarse.figures.nodes}`);
    await page.locator("#density").selectOption({ label: "By curvature" });
    await atRest(page, (state) => state.document !== coarse.document);
    assert.equal((await documentOf(page)).surfaces[1].density, "curvature");
    await page.locator("#density").selectOption({ index: 0 });
    await atRest(page, (state) => state.document === coarse.document);
    await page.locator("#spacing").fill("");
    await page.locator("#spacing").press("Enter");
    await atRest(page, (state) => state.document === before.document);
    await shows(page, "spacing", "");
  });
});
