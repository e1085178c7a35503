// A curve can be told in which direction to pass a point: typed in the properties, and given back.

import assert from "node:assert/strict";
import { test } from "node:test";
import { atRest, documentOf, wide } from "./support/model.mjs";
import { until, untilInspect, withPage } from "./support/page.mjs";

/** Waits until a field shows a text. */
function shows(page, id, text) {
  return until(page, ([id, text]) => document.getElementById(id).checkVisibility() && document.getElementById(id).value === text, [id, text], { timeout: 5000 });
}

test("a tangent is typed, bends the curve, and is given back", async () => {
  await withPage({ viewport: wide }, async (page) => {
    const before = await atRest(page);
    await page.locator('#scene-list [data-subject="point 1"]').click();
    await shows(page, "tangent-z", "");
    await page.locator("#tangent-z").fill("0.5");
    await page.keyboard.press("Enter");
    const bent = await atRest(page, (state) => state.document !== before.document);
    assert.deepEqual(bent.banners, []);
    const { tangents } = (await documentOf(page)).curves[1];
    assert.deepEqual(Object.keys(tangents), ["1"]);
    assert.ok(Math.abs(tangents[1][2]) > 0.1, `the curve rises at the point: ${tangents[1]}`);
    const off = bent.curves[0].screen.some(([x, y], k) => Math.hypot(x - before.curves[0].screen[k]?.[0], y - before.curves[0].screen[k]?.[1]) > 3);
    assert.ok(off, "the curve on the screen is another");
    await page.locator("#free-tangent").click();
    await atRest(page, (state) => state.document === before.document);
    await shows(page, "tangent-z", "");
    assert.equal(await page.locator("#free-tangent").isVisible(), false, "a free tangent cannot be freed");
  });
});

test("a tangent that is no number is refused beside its field, and the model stays", async () => {
  await withPage({ viewport: wide }, async (page) => {
    const before = await atRest(page);
    await page.locator('#scene-list [data-subject="point 1"]').click();
    await shows(page, "tangent-x", "");
    await page.locator("#tangent-x").fill("up");
    await page.keyboard.press("Enter");
    await until(page, () => document.getElementById("number-error").checkVisibility(), null, { timeout: 5000 });
    const after = await untilInspect(page, ({ settled }) => settled);
    assert.equal(after.document, before.document);
  });
});
