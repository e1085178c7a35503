// The main job with a real pointer: take hold, pull, see it follow, rest, take back.

import assert from "node:assert/strict";
import { test } from "node:test";
import { assertOnCanvas, atRest, distance, newPoints, onBareSurface, picture, point, pointAway, wide } from "./support/model.mjs";
import { inspect, untilInspect, withPage } from "./support/page.mjs";
import { difference } from "./support/pixels.mjs";
import { doubleClick, drag } from "./support/pointer.mjs";

const options = { viewport: wide };
/** Pixels by which a control may miss the pointer: what a hand takes hold of is what is under it. */
const exactly = 2;

test("a control point follows the pointer, the shape rests, undo and redo are exact", async () => {
  await withPage(options, async (page) => {
    await pointAway(page);
    const before = await atRest(page);
    const seen = await picture(page);
    const from = point(before, 7).screen;
    const to = [from[0] + 10, from[1] - 90];
    await assertOnCanvas(page, from, to);
    await drag(page, from, to, {
      async beforeRelease() {
        const state = await untilInspect(page, (now) => now.held === 7 && distance(point(now, 7).screen, to) < exactly);
        assert.notEqual(state.figures.energy, before.figures.energy, "it relaxes while it is held");
        assert.equal(state.document, before.document, "nothing is committed before the release");
        await sleeps(page);
      },
    });
    await pointAway(page);
    const after = await atRest(page, (state) => state.document !== before.document);
    assert.equal(after.held, null);
    assert.equal(after.selection, "point 7");
    assert.ok(distance(point(after, 7).screen, to) < exactly, "it stays where it was let go");
    assert.ok(distance(point(after, 7).at, point(before, 7).at) > 0.1);
    assert.ok(Math.abs(after.figures.energy - before.figures.energy) > 0.1, "the energy is another");
    for (const id of [1, 2, 3, 4, 5, 6]) assert.deepEqual(point(after, id).at, point(before, id).at, `point ${id} stays`);
    const document = JSON.parse(after.document);
    assert.ok(distance(document.points[7], point(after, 7).at) < 1e-5, "the document says what the picture shows");
    const changed = difference(seen, await picture(page));
    assert.ok(changed > 0.05, `the picture is another one in ${changed} of its pixels`);
    assert.notEqual(after.undo, null);

    await page.keyboard.press("Control+z");
    const back = await atRest(page, (state) => state.document !== after.document);
    assert.equal(back.document, before.document, "undo brings the very document back");
    assert.ok(Math.abs(back.figures.energy / before.figures.energy - 1) < 0.02, "and its shape");
    const remains = difference(seen, await picture(page), 24);
    assert.ok(remains < 0.02, `the former picture is back but for ${remains}`);
    assert.notEqual(back.redo, null);

    await page.keyboard.press("Control+Shift+Z");
    const again = await atRest(page, (state) => state.document !== before.document);
    assert.equal(again.document, after.document, "redo brings the second one back");
    assert.ok(Math.abs(again.figures.energy / after.figures.energy - 1) < 0.02);
  });
});

test("dragging the bare surface makes a control point that follows", async () => {
  await withPage(options, async (page) => {
    const before = await atRest(page);
    const [from, to] = onBareSurface(before);
    await assertOnCanvas(page, from, to);
    await drag(page, from, to);
    const after = await atRest(page, (state) => state.document !== before.document);
    const [made, ...more] = newPoints(after, before);
    assert.deepEqual(more, [], "one point, not several");
    assert.equal(made.role, "Surface");
    assert.ok(distance(made.screen, to) < exactly, `it is where the pointer let go: ${made.screen} at ${to}`);
    assert.equal(after.selection, `point ${made.id}`);
    const { skeleton } = JSON.parse(after.document).surfaces[1];
    assert.ok(skeleton.vertices.includes(made.id), "the document holds the surface there");
    assert.ok(after.figures.energy > before.figures.energy, "one more control costs energy");
    assert.equal(after.surfaces[0].summary.euler, 1, "it is still a disc");

    // The next drag takes the same point, not a new one.
    await drag(page, made.screen, [made.screen[0], made.screen[1] + 30]);
    const lower = await atRest(page, (state) => state.document !== after.document);
    assert.equal(lower.points.length, after.points.length);
    assert.ok(distance(point(lower, made.id).screen, [made.screen[0], made.screen[1] + 30]) < exactly);
  });
});

test("any place of the surface is taken exactly where it is", async () => {
  await withPage(options, async (page) => {
    const before = await atRest(page);
    const [middle] = onBareSurface(before);
    // Over more than one triangle: near corners, edges and middles.
    for (const [x, y] of [[-14, 3], [-9, -8], [-4, 5], [0, -3], [3, 7], [7, -9], [11, 1], [16, 6]]) {
      const from = [middle[0] + x, middle[1] + y];
      await assertOnCanvas(page, from);
      await page.mouse.move(...from);
      await page.mouse.down();
      await page.mouse.move(from[0] + 5, from[1]);
      await page.mouse.move(...from);
      const held = await untilInspect(page, (state) => state.held !== null && state.points.length === 8);
      await untilInspect(page, (state) => distance(point(state, held.held).screen, from) < exactly);
      await page.keyboard.press("Escape");
      await page.mouse.up();
      const after = await atRest(page, (state) => state.held === null);
      assert.equal(after.document, before.document);
    }
  });
});

test("Escape during a drag puts everything back", async () => {
  await withPage(options, async (page) => {
    await pointAway(page);
    const before = await atRest(page);
    const seen = await picture(page);
    const [from, to] = onBareSurface(before);
    await drag(page, from, to, {
      async beforeRelease() {
        const held = await untilInspect(page, (state) => state.held !== null && state.points.length === 8);
        await untilInspect(page, (state) => distance(point(state, held.held).screen, to) < exactly);
        assert.ok(difference(seen, await picture(page)) > 0.02, "the surface has been pulled");
        await page.keyboard.press("Escape");
        await untilInspect(page, (state) => state.held === null);
        // What the hand still does means nothing.
        await page.mouse.move(to[0] + 40, to[1] + 40, { steps: 5 });
      },
    });
    await pointAway(page);
    const after = await atRest(page);
    assert.equal(after.document, before.document, "the document is as before");
    assert.equal(after.undo, before.undo, "there is nothing to undo");
    assert.deepEqual(after.points.map(({ id, at }) => [id, at]), before.points.map(({ id, at }) => [id, at]));
    assert.ok(Math.abs(after.figures.energy / before.figures.energy - 1) < 1e-3, "the shape is as before");
    const remains = difference(seen, await picture(page), 24);
    assert.ok(remains < 0.005, `the picture is as before but for ${remains}`);
  });
});

test("a place of the boundary curve becomes a point of the curve; a double click releases it", async () => {
  await withPage(options, async (page) => {
    const before = await atRest(page);
    const from = onBareCurve(before);
    const to = [from[0] - 35, from[1] - 5];
    await assertOnCanvas(page, from, to);
    await drag(page, from, to);
    const after = await atRest(page, (state) => state.document !== before.document);
    const [made, ...more] = newPoints(after, before);
    assert.deepEqual(more, []);
    assert.equal(made.role, "Curve");
    assert.ok(distance(made.screen, to) < exactly, `it is where the pointer let go: ${made.screen} at ${to}`);
    const { through, closed } = JSON.parse(after.document).curves[1];
    assert.deepEqual([...through].sort(), [1, 2, 3, 4, made.id].sort(), "the curve passes through it");
    assert.ok(closed);
    assert.equal(after.surfaces.length, 1, "the surface still hangs on the curve");

    await assertOnCanvas(page, made.screen);
    const free = await doubleClicked(page, made.screen, after.document);
    assert.ok(!JSON.parse(free.document).curves[1].through.includes(made.id), "the curve has let go of it");
    assert.ok(Math.abs(free.figures.energy / before.figures.energy - 1) < 0.02, "and has its former shape");
    assert.equal(free.surfaces[0].summary.euler, 1);
    assert.equal((await inspect(page)).undo, free.undo);
  });
});

test("releasing a control of the surface lets it relax", async () => {
  await withPage(options, async (page) => {
    const before = await atRest(page);
    const from = point(before, 7).screen;
    await drag(page, from, [from[0], from[1] - 60]);
    const pulled = await atRest(page, (state) => state.document !== before.document);
    const after = await doubleClicked(page, point(pulled, 7).screen, pulled.document);
    assert.ok(!JSON.parse(after.document).surfaces[1].skeleton.vertices.includes(7));
    assert.ok(after.figures.energy < pulled.figures.energy - 0.5, "without the control that pulled it there is less energy");
  });
});

/** Double clicks and waits for what comes of it. */
async function doubleClicked(page, place, document) {
  await doubleClick(page, place);
  return atRest(page, (state) => state.document !== document);
}

/** Waits until no step is taken any more: a hand that holds still costs nothing. */
async function sleeps(page) {
  let steps = -1;
  let since = 0;
  await untilInspect(page, ({ figures }) => {
    if (figures.steps !== steps) since = Date.now();
    steps = figures.steps;
    return Date.now() - since > 500;
  });
}

/** A place of the boundary at the left, far from all controls and from where toasts appear, between its samples. */
function onBareCurve(state) {
  const samples = state.curves[0].screen;
  const free = samples.filter((place) => state.points.every(({ screen }) => distance(screen, place) > 30));
  assert.ok(free.length > 0);
  const first = free.reduce((first, place) => (place[0] < first[0] ? place : first));
  // A few pixels towards the next one lies on no sample, and still on the curve.
  const next = samples[(samples.indexOf(first) + 1) % samples.length];
  return [0, 1].map((axis) => first[axis] + (4 * (next[axis] - first[axis])) / distance(next, first));
}
