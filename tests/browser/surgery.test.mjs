// The tools of surgery, by real pointer events: what they mark before a click, what they make, what they refuse and why.

import assert from "node:assert/strict";
import { test } from "node:test";
import { atRest, distance, documentOf, drawn, point, topology, withDocument } from "./support/model.mjs";
import { inspect, until, untilInspect } from "./support/page.mjs";
import { at, pixels } from "./support/pixels.mjs";
import { arcedHole, moebius, ringOverDisc, ringedDisc, twoDiscs, twoRings } from "./support/rings.mjs";

/** A place on a curve, clear of panels and toasts and, if that can be, of control points: the sample farthest to the left. */
function onCurve(state, id) {
  const { screen } = state.curves.find((curve) => curve.id === id);
  const clear = (place) => state.points.every((entry) => distance(entry.screen, place) > 14);
  const free = screen.filter(clear);
  return (free.length > 0 ? free : screen).reduce((left, place) => (place[0] < left[0] ? place : left));
}

/** The middle of a curve's picture. */
function middleOf(state, id) {
  const { screen } = state.curves.find((curve) => curve.id === id);
  return [0, 1].map((axis) => screen.reduce((sum, place) => sum + place[axis], 0) / screen.length);
}

/** Waits until the pointer is seen where it was put: what is marked is what the tool would take. */
async function hover(page, place, marked) {
  await page.mouse.move(...place);
  return untilInspect(page, (state) => marked(state));
}

/** Clicks, and waits for the act with this name and for rest. */
async function clickFor(page, place, act, predicate = () => true) {
  await page.mouse.click(...place);
  return atRest(page, (state) => state.act === act && predicate(state));
}

/** Fails unless the click changes nothing and the toast gives a reason. */
async function refused(page, place, reason) {
  const { document } = await inspect(page);
  await page.mouse.click(...place);
  const state = await untilInspect(page, ({ toast }) => toast !== null && reason.test(toast));
  assert.equal(state.document, document, "the model is as it was");
}

const brightness = (colour) => colour.reduce((sum, channel) => sum + channel, 0);

test("a region is tinted under the pointer, burnt out by a click, and given back by the toast", async () => {
  await withDocument(ringedDisc, async (page, before) => {
    await topology(page, "χ 1 · genus 0 · 1 boundary · orientable");
    const inside = middleOf(before, 2);
    const [rim, ring] = [1, 2].map((id) => onCurve(before, id));
    const between = [0, 1].map((axis) => (rim[axis] + ring[axis]) / 2);
    await drawn(page);
    const plain = await pixels(page);
    await page.keyboard.press("b");
    await hover(page, inside, ({ marked }) => marked.tinted === 1);
    await drawn(page);
    const tinted = await pixels(page);
    const change = (place) => distance(at(plain, ...place), at(tinted, ...place));
    assert.ok(change([inside[0] + 24, inside[1] - 8]) > 15, "the region under the pointer is tinted");
    assert.ok(change(between) < 6, "the one beside it is not");

    const burnt = await clickFor(page, inside, "Burn out");
    assert.deepEqual(burnt.surfaces.map(({ summary }) => [summary.euler, summary.boundaries]), [[0, 2]]);
    await topology(page, "χ 0 · genus 0 · 2 boundaries · orientable");
    assert.equal(burnt.curves.find(({ id }) => id === 2).role, "Boundary");
    await page.mouse.move(80, 300);
    await drawn(page);
    const holed = await pixels(page);
    assert.ok(brightness(at(holed, ...inside)) > brightness(at(plain, ...inside)) + 20, "the ground shows through");
    assert.equal(burnt.tool, "burnout", "the tool stays");

    await page.locator("#toast-button").click();
    const back = await atRest(page, ({ act }) => act === "Undo Burn out");
    assert.equal(back.document, before.document);
  });
});

test("K creases a curve, and smooths the crease; the same by a click on the region", async () => {
  await withDocument(ringedDisc, async (page, before) => {
    await page.keyboard.press("k");
    await hover(page, onCurve(before, 2), ({ hover, marked }) => hover === "curve 2" && marked.tinted === 0);
    const creased = await clickFor(page, onCurve(before, 2), "Crease");
    assert.deepEqual(creased.surfaces.map(({ summary }) => summary.boundaries).sort(), [1, 2]);
    assert.equal(creased.curves.length, 2, "both banks follow the same curve");
    const smooth = await clickFor(page, onCurve(creased, 2), "Smooth");
    assert.deepEqual(smooth.surfaces.map(({ summary }) => [summary.euler, summary.boundaries]), [[1, 1]]);
    const middle = middleOf(smooth, 2);
    await hover(page, middle, ({ marked }) => marked.tinted === 1);
    await clickFor(page, middle, "Crease", ({ surfaces }) => surfaces.length === 2);
    for (const act of ["Undo Crease", "Undo Smooth", "Undo Crease"]) {
      await page.keyboard.press("Control+z");
      await atRest(page, (state) => state.act === act);
    }
    assert.equal((await inspect(page)).document, before.document);
  });
});

test("a split doubles the curve; both sides move apart", async () => {
  await withDocument(ringedDisc, async (page, before) => {
    await page.keyboard.press("x");
    assert.equal((await inspect(page)).tool, "split");
    const cut = await clickFor(page, middleOf(before, 2), "Split");
    assert.deepEqual([cut.surfaces.length, cut.curves.length, cut.points.length], [2, 3, 12]);
    await page.keyboard.press("Control+z");
    assert.equal((await atRest(page, ({ act }) => act === "Undo Split")).document, before.document);
  });
});

test("a sheet fills a hole between two curves: both are marked over either, and a click on one fills it", async () => {
  await withDocument(arcedHole, async (page, before) => {
    assert.deepEqual(before.surfaces.map(({ summary }) => [summary.euler, summary.boundaries]), [[0, 2]]);
    await drawn(page);
    const hole = middleOf(before, 1);
    // Both arcs end at the same places: between these they are apart.
    const inside = (arc) => {
      const { screen } = before.curves.find((curve) => curve.id === arc);
      return screen[Math.floor(screen.length / 2)];
    };
    const plain = await pixels(page);
    await page.keyboard.press("s");
    // The rim of the disc is closed: by itself it is the loop.
    await hover(page, onCurve(before, 1), ({ hover, marked }) => hover === "curve 1" && marked.skins === 1 && marked.lines === 0);
    for (const arc of [3, 2]) {
      await hover(page, inside(arc), ({ hover, marked }) => hover === `curve ${arc}` && marked.lines === 2 && marked.skins === 1);
    }
    await drawn(page);
    const skinned = await pixels(page);
    if (process.env.PICTURES) await page.screenshot({ path: `${process.env.PICTURES}/sheet-in-arcs.png` });
    assert.ok(distance(at(plain, ...hole), at(skinned, ...hole)) > 6, "the skin is shown in the hole");
    const filled = await clickFor(page, inside(2), "Sheet");
    assert.deepEqual(filled.surfaces.map(({ summary }) => [summary.euler, summary.boundaries]), [[0, 2], [1, 1]]);
    assert.equal(filled.curves.length, 3, "both lie on the same arcs");
    await page.mouse.move(80, 300);
    await drawn(page);
    if (process.env.PICTURES) await page.screenshot({ path: `${process.env.PICTURES}/sheet-in-arcs-filled.png` });
    assert.ok(brightness(at(await pixels(page), ...hole)) < brightness(at(plain, ...hole)) - 20, "the ground shows through no more");
    await page.keyboard.press("Control+z");
    assert.equal((await atRest(page, ({ act }) => act === "Undo Sheet")).document, before.document);
  });
});

test("a sweep shows its ties over the second curve, R crosses them, and the skin is made", async () => {
  await withDocument(twoRings, async (page, before) => {
    const [low, high] = [1, 2].map((id) => onCurve(before, id));
    await page.keyboard.press("w");
    await page.mouse.click(...low);
    await untilInspect(page, ({ underWay }) => underWay);
    await hover(page, high, ({ marked, hover }) => hover === "curve 2" && marked.lines === 24);
    await drawn(page);
    const straight = await pixels(page);
    await page.keyboard.press("r");
    await until(page, () => document.getElementById("option-reversed").ariaPressed === "true");
    await drawn(page);
    const crossed = await pixels(page);
    assert.notDeepEqual(straight.data, crossed.data, "other ties are shown");
    await page.keyboard.press("r");
    const swept = await clickFor(page, high, "Sweep");
    assert.deepEqual(swept.surfaces.map(({ summary }) => [summary.euler, summary.boundaries]), [[0, 2]]);
    assert.equal(swept.underWay, false);
    await page.mouse.click(...low);
    await untilInspect(page, ({ underWay }) => underWay);
    await page.keyboard.press("Escape");
    await untilInspect(page, ({ underWay, tool }) => !underWay && tool === "sweep");
    await page.keyboard.press("Escape");
    await untilInspect(page, ({ tool }) => tool === "shape");
  });
});

test("a sweep takes stretches from control point to control point, and shows them before the click", async () => {
  await withDocument(twoRings, async (page, before) => {
    const place = (id) => point(before, id).screen;
    await page.keyboard.press("w");
    await hover(page, place(1), ({ hover }) => hover === "point 1");
    await page.mouse.click(...place(1));
    await untilInspect(page, ({ underWay }) => underWay);
    await until(page, () => /at which the stretch ends/.test(document.getElementById("hint").textContent));
    await hover(page, place(2), ({ hover, marked }) => hover === "point 2" && marked.lines === 1);
    await page.mouse.click(...place(2));
    await until(page, () => /other curve/.test(document.getElementById("hint").textContent));
    // Escape takes the last step back, then the next.
    await page.mouse.click(...place(5));
    await until(page, () => /stretch ends/.test(document.getElementById("hint").textContent));
    await page.keyboard.press("Escape");
    await until(page, () => /other curve/.test(document.getElementById("hint").textContent));
    await page.mouse.click(...place(5));
    await until(page, () => /stretch ends/.test(document.getElementById("hint").textContent));
    await hover(page, place(6), ({ hover, marked }) => hover === "point 6" && marked.lines === 26);
    const swept = await clickFor(page, place(6), "Sweep");
    assert.deepEqual(swept.surfaces.map(({ summary }) => [summary.euler, summary.boundaries]), [[1, 1]]);
    const { curves, surfaces } = await documentOf(page);
    const rims = surfaces[1].skeleton.curves.map(({ curve }) => curves[curve].through);
    assert.deepEqual(rims, [[1, 2], [5, 6]]);
    assert.equal(Object.keys(curves).length, 4, "both rings were divided");
    await page.keyboard.press("Control+z");
    assert.equal((await atRest(page, ({ act }) => act === "Undo Sweep")).document, before.document);
  });
});

test("a free curve is embedded in the surface below it, which comes to the curve", async () => {
  await withDocument(ringOverDisc, async (page, before) => {
    const ring = onCurve(before, 2);
    const disc = [0, 1].map((axis) => (point(before, 1).screen[axis] + point(before, 4).screen[axis]) / 2);
    const below = disc.map((value, axis) => value + 0.12 * (middleOf(before, 1)[axis] - value));
    await page.keyboard.press("i");
    await until(page, () => /curve that should lie in a surface/.test(document.getElementById("hint").textContent));
    await page.mouse.click(...ring);
    await untilInspect(page, ({ underWay }) => underWay);
    await hover(page, below, ({ marked }) => marked.tinted === 1 && marked.lines > 10);
    const embedded = await clickFor(page, below, "Embed");
    assert.deepEqual(embedded.curves.map(({ id, role }) => [id, role]), [[1, "Boundary"], [2, "Inner"]]);
    const { points, surfaces } = await documentOf(page);
    assert.deepEqual(points, JSON.parse(before.document).points, "the curve has not moved");
    assert.equal(surfaces[1].skeleton.curves.length, 2);
    assert.ok(embedded.figures.energy > 1, "the disc has risen to it");
    // The same again is refused with a reason.
    await page.mouse.click(...ring);
    await untilInspect(page, ({ underWay }) => underWay);
    await page.mouse.click(...below);
    await untilInspect(page, ({ toast }) => toast?.includes("lies in surface 1 already"));
    await page.keyboard.press("Control+z");
    assert.equal((await atRest(page, ({ act }) => act === "Undo Embed")).document, before.document);
    await page.keyboard.press("Escape");
    await untilInspect(page, ({ tool }) => tool === "shape");
  });
});

test("a loop grows by a number or to the size of another", async () => {
  await withDocument(twoRings, async (page, before) => {
    await page.locator('#scene-list [data-subject="curve 2"]').click();
    const shows = (text) =>
      until(page, (text) => document.getElementById("loop-radius").value === text, text, { timeout: 5000 });
    await shows("0.5");
    await page.locator("#loop-radius").fill("0.3*2.5");
    await page.keyboard.press("Enter");
    await atRest(page, ({ act }) => act === "Expand");
    await shows("0.75");
    const radii = async () => [5, 6, 7, 8].map((id) => places[id]).map(([x, y]) => Math.hypot(x, y));
    let places = (await documentOf(page)).points;
    for (const radius of await radii()) assert.ok(Math.abs(radius - 0.75) < 1e-6, `${radius}`);

    await page.locator("#match").click();
    await untilInspect(page, ({ tool, underWay }) => tool === "match" && underWay);
    await clickFor(page, onCurve(before, 1), "Expand", ({ tool }) => tool === "shape");
    places = (await documentOf(page)).points;
    for (const radius of await radii()) assert.ok(Math.abs(radius - 1) < 1e-6, `${radius}`);
    for (const id of [5, 6, 7, 8]) assert.equal(places[id][2], 0.8);
  });
});

test("a surface is turned inside out by its button", async () => {
  await withDocument(ringedDisc, async (page, before) => {
    assert.equal(await page.locator("#reverse").isVisible(), false, "nothing is selected");
    await page.locator('#scene-list [data-subject="surface 1"]').click();
    await page.locator("#reverse").click();
    const turned = await atRest(page, ({ act }) => act === "Reverse");
    assert.notEqual(turned.document, before.document);
    assert.deepEqual(turned.surfaces[0].summary, before.surfaces[0].summary);
    assert.equal(await page.locator("#propagate").isVisible(), false, "no other surface meets it");
  });
});

test("the outside of a surface is given to those that meet it by its button", async () => {
  await withDocument(twoDiscs, async (page) => {
    await page.locator('#scene-list [data-subject="surface 1"]').click();
    await page.locator("#propagate").click();
    await page.getByText(/has its outside there already/).first().waitFor();
  });
});

test("what does not apply is not marked, and is refused with its reason", async () => {
  await withDocument(twoDiscs, async (page, before) => {
    const rim = onCurve(before, 1);
    await page.keyboard.press("b");
    await refused(page, [400, 540], /no surface here/);
    await page.keyboard.press("k");
    await refused(page, rim, /Only one surface ends at this curve/);
    await page.keyboard.press("x");
    await refused(page, middleOf(before, 2), /single region: draw a closed curve/);
    await refused(page, rim, /ends at this curve already/);
    await page.keyboard.press("t");
    await page.mouse.click(...middleOf(before, 2));
    await untilInspect(page, ({ underWay }) => underWay);
    await refused(page, middleOf(before, 2), /same surface/);
    await page.keyboard.press("g");
    await refused(page, [400, 540], /no rim here/);
    await page.keyboard.press("d");
    await refused(page, [400, 540], /drawn on a surface/);
  });
});

test("curves that are unlike, a rim and itself, and a region with one side are refused, each with its own reason", async () => {
  const open = { through: [5, 6, 7], closed: false };
  const unlike = { ...twoRings, name: "A ring and an arc", curves: { 1: twoRings.curves[1], 2: open } };
  await withDocument(unlike, async (page, before) => {
    const [ring, arc] = [1, 2].map((id) => onCurve(before, id));
    await page.keyboard.press("s");
    await refused(page, arc, /only a closed curve can be skinned/);
    await page.keyboard.press("w");
    await hover(page, ring, ({ hover }) => hover === "curve 1");
    await page.mouse.click(...ring);
    await untilInspect(page, ({ underWay }) => underWay);
    await refused(page, ring, /two different curves/);
    await hover(page, arc, ({ hover, marked }) => hover === "curve 2" && marked.lines === 0);
    await refused(page, arc, /closed and the other is open/);
  });
  await withDocument(twoDiscs, async (page, before) => {
    const one = onCurve(before, 1);
    await page.keyboard.press("g");
    await page.mouse.click(...one);
    await untilInspect(page, ({ underWay }) => underWay);
    // A click on its surface takes the same rim, which is marked once.
    const beside = [one[0] + 12, one[1]];
    await hover(page, beside, ({ marked }) => marked.rims === 1 && marked.lines === 0);
    await refused(page, beside, /same rim .* cannot be joined with itself/);
  });
  await withDocument(moebius, async (page, strip) => {
    await topology(page, "χ 0 · crosscaps 1 · 1 boundary · one-sided");
    await page.keyboard.press("k");
    await hover(page, onCurve(strip, 1), ({ hover }) => hover === "curve 1");
    await refused(page, onCurve(strip, 1), /one side/);
    await page.keyboard.press("x");
    const band = await clickFor(page, onCurve(strip, 1), "Split");
    assert.deepEqual(band.surfaces.map(({ summary }) => [summary.boundaries, summary.orientable]), [[2, true]]);
  });
});
