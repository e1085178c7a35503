// The graphics device is lost: it is replaced, and the model is untouched.

import assert from "node:assert/strict";
import { test } from "node:test";
import { atRest, picture, pointAway, pulled, wide } from "./support/model.mjs";
import { provoke, untilInspect, withPage } from "./support/page.mjs";
import { colours, difference } from "./support/pixels.mjs";

test("a lost graphics device is replaced and shows the same picture", async () => {
  await withPage({ viewport: wide }, async (page) => {
    const before = await pulled(page);
    await page.keyboard.press("Escape");
    await pointAway(page);
    const seen = await picture(page);
    await provoke(page, "lose-device");
    const after = await untilInspect(page, (state) => state.losses === 1 && state.gpu === "ready");
    assert.equal(after.document, before.document);
    assert.deepEqual(after.figures, before.figures, "the model is untouched, to the last step");
    assert.equal(after.restarts, 0, "the worker had no part in it");
    assert.match(after.banners.join(), /graphics device was lost and has been replaced/);
    // The banner goes by itself.
    await untilInspect(page, (state) => state.banners.length === 0 && state.pictures > before.pictures);
    await pointAway(page);
    const again = await picture(page);
    assert.ok(colours(again) > 20);
    const changed = difference(seen, again);
    assert.ok(changed < 0.002, `the picture is the same but for ${changed}`);
    await pulled(page);
  });
});

test("a device lost again and again ends in a message that offers to try once more", async () => {
  await withPage({ viewport: wide }, async (page) => {
    const before = await atRest(page);
    for (let losses = 1; losses <= 4; losses += 1) {
      await untilInspect(page, (state) => state.gpu === "ready");
      await provoke(page, "lose-device");
      await untilInspect(page, (state) => state.losses === losses);
    }
    const lost = await untilInspect(page, (state) => state.banners.some((text) => /again and again/.test(text)));
    assert.equal(lost.gpu, "lost");
    assert.equal(lost.document, before.document);
    await page.locator('[data-command="redo-stage"]').click();
    await untilInspect(page, (state) => state.gpu === "ready");
    await pulled(page);
  });
});
