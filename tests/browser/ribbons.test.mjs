// A surface can be told how to leave a curve, and which normal to have at a control point: typed in the properties, and given back.

import assert from "node:assert/strict";
import { test } from "node:test";
import { atRest, documentOf, wide } from "./support/model.mjs";
import { until, untilInspect, withPage } from "./support/page.mjs";

/** Waits until a field shows a text. */
function shows(page, id, text) {
  return until(page, ([id, text]) => document.getElementById(id).checkVisibility() && document.getElementById(id).value === text, [id, text], { timeout: 5000 });
}

async function type(page, id, text) {
  await page.locator(`#${id}`).fill(text);
  await page.keyboard.press("Enter");
}

test("a rim is left at an angle, which the field shows, and set free", async () => {
  await withPage({ viewport: wide }, async (page) => {
    const before = await atRest(page);
    await page.locator('#scene-list [data-subject="curve 1"]').click();
    await shows(page, "ribbon-angle", "");
    assert.equal(await page.locator("#free-ribbon").isVisible(), false, "what is free cannot be freed");
    let last = before.document;
    for (const angle of ["75", "-30"]) {
      await type(page, "ribbon-angle", angle);
      const bent = await atRest(page, (state) => state.document !== last);
      last = bent.document;
      assert.deepEqual(bent.banners, []);
      await shows(page, "ribbon-angle", angle);
      const { curves, surfaces } = await documentOf(page);
      const { cross } = surfaces[1].ribbons[1];
      assert.deepEqual(Object.keys(cross).map(Number), [...curves[1].through].sort((a, b) => a - b));
      for (const direction of Object.values(cross)) {
        const rise = (Math.asin(direction[2] / Math.hypot(...direction)) * 180) / Math.PI;
        assert.ok(Math.abs(rise - Number(angle)) < 0.01, `${direction} rises by ${rise}`);
      }
    }
    await page.locator("#free-ribbon").click();
    await atRest(page, (state) => state.document === before.document);
    await shows(page, "ribbon-angle", "");
  });
});

test("a normal is typed, tilts the surface, and is given back", async () => {
  await withPage({ viewport: wide }, async (page) => {
    const before = await atRest(page);
    await page.locator('#scene-list [data-subject="point 5"]').click();
    await shows(page, "normal-x", "");
    await type(page, "normal-x", "0.8");
    const tilted = await atRest(page, (state) => state.document !== before.document);
    assert.deepEqual(tilted.banners, []);
    const { normals } = (await documentOf(page)).surfaces[1];
    assert.equal(normals[5][0], 0.8);
    await shows(page, "normal-x", "0.8");
    await page.locator("#free-normal").click();
    await atRest(page, (state) => state.document === before.document);
    await shows(page, "normal-x", "");
  });
});

test("what cannot be is refused with its reason, and the model stays", async () => {
  await withPage({ viewport: wide }, async (page) => {
    const before = await atRest(page);
    await page.locator('#scene-list [data-subject="curve 1"]').click();
    await shows(page, "ribbon-angle", "");
    for (const text of ["steep", "200"]) {
      await type(page, "ribbon-angle", text);
      await until(page, () => document.getElementById("number-error").checkVisibility(), null, { timeout: 5000 });
    }
    assert.equal((await untilInspect(page, ({ settled }) => settled)).document, before.document);
  });
});
