// Figure 3.1 of Welch's thesis by hand: from an empty document to a torus, with nothing but a pointer; Z is held to the axis while it drags.

import assert from "node:assert/strict";
import { readFile } from "node:fs/promises";
import { test } from "node:test";
import { assertOnCanvas, atRest, choose, distance, drawn, newPoints, point, wide } from "./support/model.mjs";
import { inspect, untilInspect, withPage } from "./support/page.mjs";
import { drag } from "./support/pointer.mjs";

/** Four places round a place of the window. */
const ring = (middle, radius) => [[radius, 0], [0, -radius], [-radius, 0], [0, radius]].map(([x, y]) => [middle[0] + x, middle[1] + y]);

/** Takes a tool in hand by its button. */
async function take(page, tool) {
  await page.locator(`#tool-${tool}`).click();
  await untilInspect(page, (state) => state.tool === tool);
}

/** Clicks places and the first again: a closed curve. */
async function loop(page, tool, places, act) {
  await take(page, tool);
  await assertOnCanvas(page, ...places);
  for (const [index, place] of places.entries()) {
    await page.mouse.click(...place);
    await untilInspect(page, ({ corners }) => corners === index + 1);
  }
  await page.mouse.click(...places[0]);
  return atRest(page, (state) => state.act === act && state.corners === 0);
}

/** Where a place of the model is in the window. */
function screenOf({ camera, points }, at) {
  const dot = (a, b) => a.reduce((sum, value, axis) => sum + value * b[axis], 0);
  const seen = (place) => {
    const away = place.map((value, axis) => value - camera.eye[axis]);
    const depth = dot(away, camera.forward);
    return [dot(away, camera.right) / depth, dot(away, camera.up) / depth];
  };
  // The length of the lens, from the point that is farthest off the axis.
  const far = points.map((entry) => [entry, seen(entry.at)]).reduce((a, b) => (Math.abs(b[1][0]) > Math.abs(a[1][0]) ? b : a));
  const lens = (far[0].screen[0] - camera.middle[0]) / far[1][0];
  const [x, y] = seen(at);
  return [camera.middle[0] + lens * x, camera.middle[1] - lens * y];
}

/** Drags a control point straight up by a length. */
async function raise(page, id, height) {
  const before = await inspect(page);
  const { at, screen } = point(before, id);
  const to = screenOf(before, [at[0], at[1], at[2] + height]);
  await assertOnCanvas(page, screen, to);
  await page.mouse.move(...screen);
  await page.mouse.down();
  await page.mouse.move(screen[0], screen[1] - 8, { steps: 2 });
  await page.keyboard.press("z");
  await page.mouse.move(...to, { steps: 12 });
  await page.mouse.up();
  const after = await atRest(page, (state) => state.held === null && state.document !== before.document);
  const [x, y, z] = point(after, id).at;
  const off = Math.hypot(x - at[0], y - at[1], z - at[2] - height);
  assert.ok(off < 0.02 * Math.abs(height), `from ${at} by ${height} it went to ${[x, y, z]}`);
  return after;
}

/** A place on a curve in plain sight: the first of its samples, from below, at which the tool in hand would take it. */
async function onCurve(page, id) {
  const state = await inspect(page);
  const { screen } = state.curves.find((curve) => curve.id === id);
  const clear = ([x, y]) => state.points.every(({ screen: [px, py] }) => Math.hypot(px - x, py - y) > 14);
  for (const place of screen.filter(clear).sort((a, b) => b[1] - a[1])) {
    const over = await page.evaluate(([x, y]) => document.elementFromPoint(x, y)?.id, place);
    if (over !== "view") continue;
    await page.mouse.move(...place);
    await drawn(page);
    if ((await inspect(page)).hover === `curve ${id}`) return place;
  }
  return assert.fail(`curve ${id} is nowhere in sight`);
}

/** Clicks on a curve with the tool in hand and waits for the act. */
async function click(page, id, act) {
  await page.mouse.click(...(await onCurve(page, id)));
  return atRest(page, (state) => state.act === act);
}

/** The vertices of the surface in full precision, from its export. */
async function vertices(page) {
  const [file] = await Promise.all([page.waitForEvent("download", { timeout: 60_000 }), choose(page, "file", "export-obj")]);
  const lines = (await readFile(await file.path(), "utf8")).split("\n");
  return lines.filter((line) => line.startsWith("v ")).map((line) => line.split(" ").slice(1).map(Number));
}

/** How far the nearest of some places is. */
const nearest = (at, among) => Math.min(...among.map((place) => distance(at, place)));

test("figure 3.1: a disc becomes a torus, is taken back to nothing, and comes again", async () => {
  await withPage({ viewport: wide }, async (page) => {
    await atRest(page);
    await choose(page, "file", "new");
    const empty = await atRest(page, ({ points }) => points.length === 0);
    await choose(page, "edit", "view-top");
    const { middle } = (await atRest(page, ({ camera }) => camera.forward[2] < -0.99)).camera;

    // (a, b) A curve and a sheet over it; (c) two curves drawn on the sheet.
    await loop(page, "curve", ring(middle, 190), "Curve");
    await take(page, "sheet");
    await page.mouse.click(...(await onCurve(page, 1)));
    const sheet = await atRest(page, ({ surfaces }) => surfaces.length === 1);
    const wall = newPoints(await loop(page, "draw", ring(middle, 104), "Draw"), sheet);
    const walled = await inspect(page);
    const hole = newPoints(await loop(page, "draw", ring(middle, 66), "Draw"), walled);
    assert.deepEqual([wall.length, hole.length], [4, 4]);

    // (d) What is inside the inner one is burnt out.
    await take(page, "burnout");
    await page.mouse.click(...middle);
    const burnt = await atRest(page, ({ act }) => act === "Burn out");
    assert.deepEqual([burnt.surfaces[0].summary.euler, burnt.surfaces[0].summary.boundaries], [0, 2]);

    // (e) Both are raised, the rim of the hole twice as high: the wall will run round the middle of the hole. Much nearer to
    // one end than to the other it would not hold the hole open: an ever narrower neck bends less.
    await take(page, "shape");
    await drag(page, [120, 460], [120, 415], { button: "right" });
    const radius = point(burnt, 1).at[0];
    // In two rounds, so that neither hides points of the other; from the front to the back, so that no rim hides its own.
    const inOrder = (points) => [3, 0, 2, 1].map((index) => points[index].id);
    for (let round = 0; round < 2; round += 1) {
      for (const id of inOrder(wall)) await raise(page, id, 0.2 * radius);
      for (const id of inOrder(hole)) await raise(page, id, 0.4 * radius);
    }

    // (f) The rim grows to the size of the outer curve; (g) the two are swept, and smoothed.
    await page.locator('#scene-list [data-subject="curve 3"]').click();
    await page.locator("#match").click();
    await untilInspect(page, ({ tool }) => tool === "match");
    const expanded = await click(page, 1, "Expand");
    // As far as it jumps, it leaves no crumple: it rests at the energy that it has when it grows little by little.
    assert.ok(Math.abs(expanded.figures.energy - 30.3) < 0.3 && expanded.figures.residual < 1e-5, JSON.stringify(expanded.figures));
    await take(page, "sweep");
    await page.mouse.click(...(await onCurve(page, 1)));
    await untilInspect(page, ({ underWay }) => underWay);
    const swept = await click(page, 3, "Sweep");
    assert.equal(swept.surfaces.length, 2);
    await take(page, "crease");
    // One right after the other: while one is a crease, the surface can turn there and lets the hole close.
    const seams = [await onCurve(page, 1), await onCurve(page, 3)];
    await page.mouse.click(...seams[0]);
    await untilInspect(page, ({ act }) => act === "Smooth");
    await page.mouse.click(...seams[1]);
    const torus = await atRest(page, ({ curves }) => curves.every(({ role }) => role === "Inner"));

    const [surface, ...more] = torus.surfaces;
    assert.deepEqual(more, []);
    assert.deepEqual(surface.summary, { euler: 0, boundaries: 0, components: 1, orientable: true, genus: 1 });
    assert.equal(await page.locator("#figure-topology").textContent(), "χ 0 · genus 1 · closed · orientable");
    assert.deepEqual(torus.curves.map(({ role }) => role), ["Inner", "Inner", "Inner"]);
    assert.ok(torus.figures.energy > 20 && torus.figures.energy < 200, `${torus.figures.energy}`);

    // The surface runs through all control points exactly, and through what the page draws of the three curves.
    const surfaceAt = await vertices(page);
    const { points, curves } = JSON.parse(torus.document);
    for (const { through } of Object.values(curves)) {
      assert.equal(through.length, 4);
      for (const id of through) assert.ok(nearest(points[id], surfaceAt) < 1e-9, `point ${id}: ${nearest(points[id], surfaceAt)}`);
    }
    for (const { id, at } of torus.curves) {
      assert.ok(at.length >= 3);
      for (const place of at) assert.ok(nearest(place, surfaceAt) < 1e-6, `curve ${id} is ${nearest(place, surfaceAt)} away`);
    }

    // All the way back and forth again.
    let acts = 0;
    for (let state = torus; state.document !== empty.document; acts += 1) {
      await page.locator("#undo").click();
      const before = state.document;
      state = await untilInspect(page, ({ document }) => document !== before);
    }
    assert.equal(acts, 25, "a curve, a sheet, two drawn curves, a hole, eight points raised twice, an expansion, a sweep, two smoothings");
    for (let state = await inspect(page); state.redo !== null; ) {
      await page.locator("#redo").click();
      const before = state.document;
      state = await untilInspect(page, ({ document }) => document !== before);
    }
    const again = await atRest(page);
    assert.equal(again.document, torus.document);
    assert.deepEqual(again.surfaces[0].summary, surface.summary);
    // What rested when it was left is brought back as it was, to the bit.
    assert.equal(again.figures.energy, torus.figures.energy);
  });
});
