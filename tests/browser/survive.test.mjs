// Trouble: the worker dies, the graphics device is lost, the page is reloaded, there are two of it.

import assert from "node:assert/strict";
import { test } from "node:test";
import { assertSame, atRest, picture, point, pointAway, pulled, said, wide } from "./support/model.mjs";
import { inspect, open, provoke, started, untilInspect, withPage } from "./support/page.mjs";
import { colours, difference } from "./support/pixels.mjs";
import { drag } from "./support/pointer.mjs";

test("a killed worker is replaced, the model comes back and can be worked with", async () => {
  await withPage({ viewport: wide }, async (page) => {
    const before = await pulled(page);
    await provoke(page, "kill-worker");
    await said(page, /The solver stopped and was started again\. Nothing was lost/);
    const after = await atRest(page, (state) => state.restarts === 1 && state.worker === "ready");
    assertSame(after, before);
    await pulled(page);
  });
});

test("a worker that dies in a drag costs that drag and no more", async () => {
  await withPage({ viewport: wide }, async (page) => {
    const before = await pulled(page);
    const from = point(before, 6).screen;
    await drag(page, from, [from[0], from[1] - 30], {
      async beforeRelease() {
        await untilInspect(page, (state) => state.held === 6);
        await provoke(page, "kill-worker");
        await said(page, /Only the drag was lost/);
        await page.mouse.move(from[0] + 20, from[1] - 40, { steps: 4 });
      },
    });
    const after = await atRest(page, (state) => state.restarts === 1 && state.worker === "ready");
    assertSame(after, before);
    assert.equal(after.held, null);
    await pulled(page);
  });
});

test("a worker that hangs is noticed and replaced", async () => {
  await withPage({ viewport: wide }, async (page) => {
    const before = await pulled(page);
    await provoke(page, "hang-worker");
    const from = point(before, 6).screen;
    await drag(page, from, [from[0], from[1] - 30]);
    await said(page, /The solver stopped and was started again\. Only the drag was lost/);
    const after = await atRest(page, (state) => state.restarts === 1 && state.worker === "ready");
    assertSame(after, before);
    await pulled(page);
  });
});

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

test("a reload brings back what was there, also twice", async () => {
  await withPage({ viewport: wide }, async (page) => {
    let before = await pulled(page);
    for (const round of [1, 2]) {
      await page.reload();
      await started(page);
      const after = await atRest(page);
      assertSame(after, before);
      assert.deepEqual(after.banners, [], `round ${round}`);
      before = await pulled(page);
    }
  });
});

test("two tabs keep their own documents", async () => {
  const session = await open({ viewport: wide });
  try {
    const first = session.page;
    const mine = await pulled(first);
    const second = await session.visit();
    const copy = await atRest(second);
    assert.equal(copy.document, mine.document, "a new tab goes on with the newest document");
    const theirs = await pulled(second);
    assert.notEqual(theirs.document, mine.document);
    assert.equal((await inspect(first)).document, mine.document);

    await first.reload();
    await started(first);
    assert.equal((await atRest(first)).document, mine.document, "the first tab has its own");
    await second.reload();
    await started(second);
    assert.equal((await atRest(second)).document, theirs.document, "and so has the second");
    session.assertQuiet();
  } finally {
    await session.close();
  }
});
