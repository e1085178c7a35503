// Trouble: the worker dies, the page is reloaded, there are two of it.

import assert from "node:assert/strict";
import { test } from "node:test";
import { assertSame, atRest, point, pulled, said, wide } from "./support/model.mjs";
import { inspect, open, provoke, started, untilInspect, withPage } from "./support/page.mjs";
import { drag } from "./support/pointer.mjs";

test("a killed worker is replaced, the model comes back and can be worked with", async () => {
  await withPage({ viewport: wide }, async (page) => {
    const older = await pulled(page);
    const before = await pulled(page);
    await provoke(page, "kill-worker");
    await said(page, /The solver stopped and was started again\. Nothing was lost/);
    const after = await atRest(page, (state) => state.restarts === 1 && state.worker === "ready");
    assertSame(after, before);
    assert.equal(after.undo, before.undo, "what could be taken back still can");
    await page.keyboard.press("Control+z");
    const back = await atRest(page, (state) => state.document !== before.document);
    assert.equal(back.document, older.document);
    await page.keyboard.press("Control+Shift+Z");
    assert.equal((await atRest(page, (state) => state.document !== older.document)).document, before.document);
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
