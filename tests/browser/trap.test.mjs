// A panic inside the worker: the program is thrown away and replaced, and nobody can bring one about by what they type.

import assert from "node:assert/strict";
import { test } from "node:test";
import { assertSame, atRest, point, pulled, said, wide } from "./support/model.mjs";
import { provoke, untilInspect, withPage } from "./support/page.mjs";
import { drag } from "./support/pointer.mjs";

// What the console has to say of a panic: its text, and the trap that ends the program.
const trapped = { viewport: wide, allow: /a trap was asked for|RuntimeError: unreachable/ };

test("a worker that panics is thrown away and replaced, again and again", async () => {
  await withPage(trapped, async (page, { complaints }) => {
    for (const restarts of [1, 2]) {
      const before = await pulled(page);
      await provoke(page, "trap-worker");
      await said(page, /The solver stopped and was started again\. Nothing was lost/);
      const after = await atRest(page, (state) => state.restarts === restarts && state.worker === "ready");
      assertSame(after, before);
    }
    await pulled(page);
    assert.ok(complaints.some((text) => /panicked at.*port\.rs/s.test(text)), "it was a panic");
  });
});

test("a panic in a drag costs that drag and no more", async () => {
  await withPage(trapped, async (page) => {
    const before = await pulled(page);
    const from = point(before, 6).screen;
    await drag(page, from, [from[0], from[1] - 30], {
      async beforeRelease() {
        await untilInspect(page, (state) => state.held === 6);
        await provoke(page, "trap-worker");
        await said(page, /Only the drag was lost/);
      },
    });
    const after = await atRest(page, (state) => state.restarts === 1 && state.worker === "ready");
    assertSame(after, before);
    assert.equal(after.held, null);
    await pulled(page);
  });
});

test("no document, no link and no file can say what makes a worker panic", async () => {
  await withPage({ viewport: wide, hash: "#d1=trap" }, async (page) => {
    const before = await atRest(page);
    for (const [text, reason] of [["trap", /expected ident/], ['"trap"', /invalid type: string/], ['{"c":"trap"}', /field/]]) {
      await page.locator("#file").setInputFiles({ name: "trap.json", mimeType: "application/json", buffer: Buffer.from(text) });
      await said(page, reason);
    }
    await page.locator("#name").fill("trap");
    await page.keyboard.press("Enter");
    const named = await atRest(page, ({ name }) => name === "trap");
    assert.equal(named.restarts, 0);
    assert.equal(named.surfaces.length, before.surfaces.length);
  });
});
