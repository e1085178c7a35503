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

test("steps that a safeguard rescued are counted in the status line, once there are any", async () => {
  // Hardly any shape needs one: the solver's reports are told to speak of some.
  const init = () => {
    const told = (value, rescues) => {
      if (value === null || typeof value !== "object" || ArrayBuffer.isView(value)) return;
      if (value.figures) value.figures.rescues = rescues;
      else Object.values(value).forEach((part) => told(part, rescues));
    };
    window.rescues = 0;
    window.Worker = class extends Worker {
      constructor(...given) {
        super(...given);
        this.addEventListener("message", ({ data }) => told(data, window.rescues));
      }
    };
  };
  await withPage({ viewport: wide, init }, async (page) => {
    const before = await atRest(page);
    const shown = page.locator("#figure-rescues");
    assert.equal(before.figures.rescues, 0);
    assert.equal(await shown.isVisible(), false, "nothing is said of none");
    for (const [rescues, text, to] of [[1, "1 rescue", [330, 200]], [12, "12 rescues", [360, 230]]]) {
      await page.evaluate((rescues) => (window.rescues = rescues), rescues);
      await drag(page, point(await inspect(page), 7).screen, to);
      await atRest(page, ({ figures }) => figures.rescues === rescues);
      assert.equal(await shown.textContent(), text);
      assert.ok(await shown.isVisible());
      if (process.env.PICTURES) await page.screenshot({ path: `${process.env.PICTURES}/rescues.png` });
    }
  });
});
