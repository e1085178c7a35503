// A curve can be told in which direction to pass a point: typed in the properties, and given back.

import assert from "node:assert/strict";
import { test } from "node:test";
import { assertOnCanvas, atRest, distance, documentOf, point, wide } from "./support/model.mjs";
import { inspect, until, untilInspect, withPage } from "./support/page.mjs";

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

test("a handle turns a prescribed tangent under the pointer, as one act; Escape puts it back", async () => {
  await withPage({ viewport: wide }, async (page) => {
    await atRest(page);
    await page.locator('#scene-list [data-subject="point 1"]').click();
    await shows(page, "tangent-z", "");
    assert.deepEqual((await inspect(page)).handles, [], "a free tangent has no handle");
    await page.locator("#tangent-z").fill("0.5");
    await page.keyboard.press("Enter");
    const before = await atRest(page, ({ handles }) => handles.length === 1);
    const [end] = before.handles;
    const foot = point(before, 1).screen;
    // It stands in space, so that the view shortens it.
    const length = distance(end, foot);
    assert.ok(length > 24 && length < 70, `the handle is ${length} pixels long`);
    await assertOnCanvas(page, end);
    const to = [end[0] - 50, end[1] - 40];
    const dragged = async () => {
      await page.mouse.move(...end);
      await page.mouse.down();
      for (let step = 1; step <= 8; step += 1) {
        await page.mouse.move(end[0] + ((to[0] - end[0]) * step) / 8, end[1] + ((to[1] - end[1]) * step) / 8);
      }
      return untilInspect(page, ({ held, handles }) => held === 1 && handles.length === 1 && distance(handles[0], to) < 2);
    };
    await dragged();
    await page.keyboard.press("Escape");
    const back = await atRest(page, ({ held }) => held === null);
    await page.mouse.up();
    assert.equal(back.document, before.document, "Escape puts the direction back");
    assert.ok(distance(back.handles[0], end) < 1);

    await dragged();
    await page.mouse.up();
    const turned = await atRest(page, ({ document }) => document !== before.document);
    assert.equal(turned.undo, "Tangent");
    const [was, is] = [before, turned].map(({ document }) => JSON.parse(document).curves[1].tangents[1]);
    assert.ok(distance(was, is) > 0.3, `the direction is another: ${was}, ${is}`);
    assert.equal(turned.selection, "point 1");
    // The handle points where the hand was, at its usual length.
    const towards = (place) => Math.atan2(place[1] - foot[1], place[0] - foot[0]);
    assert.ok(Math.abs(towards(turned.handles[0]) - towards(to)) < 0.05);
    if (process.env.PICTURE) await page.screenshot({ path: process.env.PICTURE });
    await page.keyboard.press("Control+z");
    const undone = await atRest(page, ({ document }) => document === before.document);
    assert.ok(distance(undone.handles[0], end) < 1, "the whole drag was one act");
  });
});
