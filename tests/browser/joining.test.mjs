// The tools that join two surfaces, by real pointer events: what they show between the two clicks, what they make, undo.

import assert from "node:assert/strict";
import { test } from "node:test";
import {
  atRest,
  distance,
  documentOf,
  drawn,
  newPoints,
  picture,
  point,
  topology,
  withDocument,
} from "./support/model.mjs";
import { until, untilInspect } from "./support/page.mjs";
import { bowlOverDisc, domeThroughDisc, twoDiscs } from "./support/rings.mjs";

/** Euler characteristic and boundaries of every surface, in order. */
const kinds = ({ surfaces }) => surfaces.map(({ summary }) => [summary.euler, summary.boundaries]);

/** Moves the pointer, and waits until the page marks what is asked for: what is marked is what a click would take. */
async function hover(page, place, marked) {
  await page.mouse.move(...place);
  return untilInspect(page, marked, { timeout: 10_000 });
}

/** Takes the last act back and fails unless that gives the document of before to the letter. */
async function takeBack(page, act, before) {
  await page.keyboard.press("Control+z");
  const back = await atRest(page, (state) => state.act === `Undo ${act}`);
  assert.equal(back.document, before.document);
  assert.deepEqual(kinds(back), kinds(before));
  return back;
}

/** A place on a curve clear of its control points and of panels: of its samples the one nearest to a corner of the picture. */
function onRim(state, id, [x, y]) {
  const { screen } = state.curves.find((curve) => curve.id === id);
  const clear = (place) => state.points.every((entry) => distance(entry.screen, place) > 14);
  return screen.filter(clear).reduce((a, b) => (distance(a, [x, y]) < distance(b, [x, y]) ? a : b));
}

/** The middle of some control points of the model, as a picture shows it. */
function between(state, ...ids) {
  const places = ids.map((id) => point(state, id).screen);
  return [0, 1].map((axis) => places.reduce((sum, place) => sum + place[axis], 0) / places.length);
}

const left = [0, 280];

test("two rims are marked, tied and glued: with a band two discs are a ball, without one too", async () => {
  await withDocument(twoDiscs, async (page, before) => {
    const [low, high] = [1, 2].map((id) => onRim(before, id, left));
    await page.keyboard.press("g");
    await hover(page, low, ({ marked }) => marked.rims === 1 && marked.lines === 0);
    await page.mouse.click(...low);
    await untilInspect(page, ({ underWay }) => underWay);
    await drawn(page);
    const untied = await picture(page);
    await hover(page, high, ({ marked }) => marked.rims === 2 && marked.lines === 24);
    await drawn(page);
    assert.notDeepEqual((await picture(page)).data, untied.data, "the ties are in the picture");
    await page.mouse.click(...high);
    const glued = await atRest(page, ({ act }) => act === "Glue");
    assert.deepEqual(kinds(glued), [[2, 0]]);
    await topology(page, "χ 2 · genus 0 · closed · orientable");
    assert.deepEqual(glued.curves.map(({ role }) => role), ["Inner", "Inner"], "both rims run on inside");
    assert.equal(glued.underWay, false);
    const back = await takeBack(page, "Glue", before);

    await page.keyboard.press("s");
    await until(page, () => document.getElementById("option-skirt").ariaPressed === "false");
    await page.mouse.click(...onRim(back, 1, left));
    await untilInspect(page, ({ underWay }) => underWay);
    await page.mouse.click(...onRim(back, 2, left));
    const laid = await atRest(page, ({ act }) => act === "Glue");
    assert.deepEqual(kinds(laid), [[2, 0]]);
    assert.deepEqual(laid.curves.map(({ id, role }) => [id, role]), [[1, "Inner"]], "the second rim lies on the first");
    assert.equal(laid.points.length, before.points.length - 4);
    await takeBack(page, "Glue", before);
  });
});

test("a tube is shown before it is made, the wheel sets its radius, and its rims have it", async () => {
  await withDocument(twoDiscs, async (page, before) => {
    const high = between(before, 5, 6, 7, 8);
    const low = between(before, 1, 2, 3, 4);
    await page.keyboard.press("m");
    await hover(page, high, ({ hover, marked }) => hover === "surface 2" && marked.lines === 0);
    await page.mouse.click(...high);
    await untilInspect(page, ({ underWay }) => underWay);
    await hover(page, low, ({ hover, marked }) => hover === "surface 1" && marked.lines === 14);
    await drawn(page);
    const narrow = await picture(page);
    const radius = () => page.locator("#tube-radius").inputValue().then(Number);
    const suited = await radius();
    assert.ok(suited > 0.05 && suited < 0.3, `${suited} suits a disc of 0.8`);
    await page.mouse.wheel(0, -240);
    await until(page, (was) => Number(document.getElementById("tube-radius").value) > was, suited);
    const wanted = await radius();
    const wheeled = await hover(page, low, ({ marked }) => marked.lines === 14);
    assert.deepEqual(wheeled.camera, before.camera, "the wheel does not zoom meanwhile");
    await drawn(page);
    assert.notDeepEqual((await picture(page)).data, narrow.data, "a wider tube is shown");
    assert.equal(wheeled.document, before.document, "nothing was done yet");

    await page.mouse.click(...low);
    const merged = await atRest(page, ({ act }) => act === "Merge");
    assert.deepEqual(kinds(merged), [[0, 2]]);
    await topology(page, "χ 0 · genus 0 · 2 boundaries · orientable");
    // The rims of the holes are control curves with the radius of the preview, on the surface that each was made in.
    const rims = (await documentOf(page)).curves;
    const made = Object.entries(rims).filter(([id]) => !before.curves.some((curve) => curve.id === Number(id)));
    assert.equal(made.length, 2);
    assert.equal(newPoints(merged, before).length, made[0][1].through.length + made[1][1].through.length);
    for (const [, { through, closed }] of made) {
      assert.ok(closed);
      const places = through.map((id) => point(merged, id).at);
      const centre = [0, 1, 2].map((axis) => places.reduce((sum, at) => sum + at[axis], 0) / places.length);
      for (const at of places) {
        const off = distance(at, centre) / wanted - 1;
        assert.ok(Math.abs(off) < 0.02, `a rim of ${distance(at, centre)}, asked for ${wanted}`);
      }
    }
    await takeBack(page, "Merge", before);
  });
});

/** Waits until the line of hints says so. */
const hint = (page, text) => until(page, (text) => document.getElementById("hint").textContent.includes(text), text, { timeout: 10_000 });

test("Enter shows the tube at the closest places, a second one makes it, Escape gives it up; its rims stay or go", async () => {
  await withDocument(bowlOverDisc, async (page, before) => {
    await page.keyboard.press("m");
    await page.keyboard.press("Enter");
    await untilInspect(page, ({ underWay, marked }) => underWay && marked.lines === 14 && marked.skins === 1);
    await hint(page, "Enter or a click makes this tube");
    await page.keyboard.press("Escape");
    await untilInspect(page, ({ underWay, marked, tool }) => !underWay && marked.lines === 0 && tool === "merge");

    // After a click the tube leads from the surface that was clicked, not from the place.
    await page.mouse.click(...between(before, 1, 2, 3, 4));
    await untilInspect(page, ({ underWay, marked }) => underWay && marked.lines === 0);
    await page.keyboard.press("Enter");
    await untilInspect(page, ({ marked }) => marked.lines === 14);
    await drawn(page);
    const suited = await picture(page);
    // As in all fields, sums are done.
    await page.locator("#tube-radius").fill("0.3/2 - 0.03");
    await page.locator("#tube-radius").press("Enter");
    await until(page, () => document.getElementById("tube-radius").value === "0.12");
    await drawn(page);
    assert.notDeepEqual((await picture(page)).data, suited.data, "the tube of that radius is shown");
    assert.equal((await untilInspect(page, ({ underWay }) => underWay)).document, before.document, "nothing was done yet");
    await page.keyboard.press("Enter");
    const merged = await atRest(page, ({ act }) => act === "Merge");
    assert.deepEqual([kinds(merged), merged.underWay], [[[0, 2]], false]);
    const made = merged.curves.filter(({ id }) => !before.curves.some((curve) => curve.id === id));
    assert.equal(made.length, 2, "both rims of the tube are control curves");
    const { points, curves } = await documentOf(page);
    for (const { id } of made) {
      const places = curves[id].through.map((point) => points[point]);
      const centre = [0, 1, 2].map((axis) => places.reduce((sum, at) => sum + at[axis], 0) / places.length);
      // The radius is laid off in the tangent plane: where the bowl rises from it, corners laid on it lie a little nearer.
      const least = centre[2] < 0.1 ? 0.98 : 0.9;
      for (const at of places) {
        const ratio = distance(at, centre) / 0.12;
        assert.ok(ratio > least && ratio < 1.02, `a rim of ${distance(at, centre)}, asked for 0.12`);
      }
      assert.ok(Math.hypot(centre[0], centre[1]) < 0.15, `${centre} is where they come closest`);
    }
    await takeBack(page, "Merge", before);

    // K: without its rims. With a pointer alone: the button shows the tube, and a click makes it, wherever it falls.
    await page.keyboard.press("k");
    await until(page, () => document.getElementById("option-keep").ariaPressed === "false");
    await page.locator("#merge-closest").click();
    await untilInspect(page, ({ marked }) => marked.lines === 14);
    await page.mouse.click(...onRim(before, 1, left));
    const free = await atRest(page, ({ act }) => act === "Merge");
    assert.deepEqual(kinds(free), [[0, 2]]);
    assert.deepEqual(free.curves.map(({ id }) => id), [1, 2], "no curve was left behind");
    await takeBack(page, "Merge", before);
  });
});

test("a second tube within one surface is a handle; where there is no room the hint says so before the click", async () => {
  await withDocument(twoDiscs, async (page, before) => {
    await page.keyboard.press("m");
    await page.locator("#tube-radius").fill("0.12");
    await page.locator("#tube-radius").press("Enter");
    // Toward a rim there is no room for the hole.
    const edge = onRim(before, 2, left).map((value, axis) => value + 0.08 * (between(before, 5, 6, 7, 8)[axis] - value));
    await page.mouse.click(...between(before, 5, 6, 7, 8));
    await untilInspect(page, ({ underWay }) => underWay);
    await hover(page, edge, ({ hover, marked }) => hover === "surface 2" && marked.lines === 14);
    await hint(page, "a rim or a curve is too near");
    const near = between(before, 5, 6, 7, 8).map((value, axis) => value + [25, 0][axis]);
    await hover(page, near, ({ marked }) => marked.lines === 14);
    await hint(page, "The holes would meet");
    await page.mouse.click(...near);
    await untilInspect(page, ({ toast }) => toast?.includes("two holes would meet"));
    await untilInspect(page, ({ document, underWay }) => document === before.document && !underWay);

    // From disc to disc twice: the first tube makes them one surface, the second gives it a handle.
    let state = before;
    for (const [high, low] of [[[5, 8], [1, 4]], [[7, 8], [3, 4]]]) {
      const was = state;
      await page.mouse.click(...between(state, ...high));
      await untilInspect(page, ({ underWay }) => underWay);
      await hover(page, between(state, ...low), ({ marked }) => marked.lines === 14);
      await page.mouse.click(...between(state, ...low));
      state = await atRest(page, ({ act, document }) => act === "Merge" && document !== was.document);
    }
    assert.deepEqual(kinds(state), [[-2, 2]], "two less than the 0 of the tube between two discs");
    await topology(page, "χ −2 · genus 1 · 2 boundaries · orientable");
  });
});

test("two surfaces that cross are trimmed at the parts that were clicked, in a crease or smoothly", async () => {
  await withDocument(domeThroughDisc, async (page, before) => {
    assert.deepEqual(kinds(before), [[1, 1], [1, 1]]);
    // The top of the dome, and the border of the disc outside it.
    const top = point(before, 9).screen.map((value, axis) => value + [0, 6][axis]);
    const rim = onRim(before, 1, left);
    const middle = between(before, 1, 2, 3, 4);
    const border = [0, 1].map((axis) => rim[axis] + 0.15 * (middle[axis] - rim[axis]));
    for (const smooth of ["false", "true"]) {
      await page.keyboard.press("t");
      if (smooth === "true") await page.keyboard.press("s");
      await until(page, (on) => document.getElementById("option-smooth").ariaPressed === on, smooth);
      await hover(page, top, ({ hover, marked }) => hover === "surface 2" && marked.tinted === 1);
      await page.mouse.click(...top);
      await untilInspect(page, ({ underWay }) => underWay);
      await drawn(page);
      const one = await picture(page);
      await hover(page, border, ({ hover, marked }) => hover === "surface 1" && marked.skins === 2 && marked.tinted === 0 && marked.lines === 1);
      await drawn(page);
      assert.notDeepEqual((await picture(page)).data, one.data, "the line in which they meet is shown before the click");
      await page.mouse.click(...border);
      const trimmed = await atRest(page, ({ act }) => act === "Trim");
      if (smooth === "true") {
        assert.deepEqual(kinds(trimmed), [[1, 1]]);
        await topology(page, "χ 1 · genus 0 · 1 boundary · orientable");
      } else {
        assert.deepEqual(kinds(trimmed), [[0, 2], [1, 1]]);
      }
      assert.equal(trimmed.curves.length, 2, "the rim of the dome went with its skirt; the seam is a control curve");
      const seam = trimmed.curves.find(({ id }) => !before.curves.some((curve) => curve.id === id));
      assert.ok(seam?.closed);
      for (const { at } of newPoints(trimmed, before)) {
        assert.ok(Math.abs(at[2] - 0.25) < 0.01, `the seam lies in the disc: ${at}`);
      }
      await takeBack(page, "Trim", before);
    }
    // With a ribbon the join is held at the angle that is typed; the field is there only while there is an angle.
    await page.keyboard.press("t");
    assert.ok(!(await page.locator("#join-angle").isVisible()));
    await page.keyboard.press("r");
    assert.ok(!(await page.locator("#join-angle").isVisible()), "a smooth join has no angle");
    await page.keyboard.press("s");
    await page.locator("#join-angle").fill("200");
    await page.locator("#join-angle").press("Enter");
    await until(page, () => /at most 180/.test(document.getElementById("number-error").textContent));
    await page.locator("#join-angle").fill("120");
    await page.locator("#join-angle").press("Enter");
    await hover(page, top, ({ hover }) => hover === "surface 2");
    await page.mouse.click(...top);
    await untilInspect(page, ({ underWay }) => underWay);
    await hover(page, border, ({ hover, marked }) => hover === "surface 1" && marked.lines === 1);
    await page.mouse.click(...border);
    await atRest(page, ({ act }) => act === "Trim");
    const { surfaces } = await documentOf(page);
    const [one, other] = Object.values(surfaces).map(({ ribbons }) => Object.values(ribbons ?? {})[0]?.cross);
    assert.ok(Object.keys(one).length >= 6 && Object.keys(other).length === Object.keys(one).length);
    for (const [id, a] of Object.entries(one)) {
      const cosine = a.reduce((sum, x, axis) => sum + x * other[id][axis], 0);
      assert.ok(Math.abs(cosine + 0.5) < 1e-6, `120 degrees were asked for: ${cosine}`);
    }
    await takeBack(page, "Trim", before);
  });
});
