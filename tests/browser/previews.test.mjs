// What tools show of a surface before the click, by real pointer events. `PICTURES=folder` keeps the pictures, `DARK=1` takes them in the dark.

import assert from "node:assert/strict";
import { test } from "node:test";
import { atRest, distance, drawn, picture, point, pointAway, withDocument } from "./support/model.mjs";
import { untilInspect } from "./support/page.mjs";
import { bowlOverDisc, domeThroughDisc, ringedDisc, twoRings } from "./support/rings.mjs";

const options = { context: { colorScheme: process.env.DARK ? "dark" : "light" } };

/** A place on a curve clear of its control points and of panels, the lowest in the picture. */
function onCurve(state, id) {
  const { screen } = state.curves.find((curve) => curve.id === id);
  const clear = screen.filter((place) => state.points.every((entry) => distance(entry.screen, place) > 14));
  return (clear.length > 0 ? clear : screen).reduce((low, place) => (place[1] > low[1] ? place : low));
}

/** The middle of some control points in the picture. */
const between = (state, ...ids) => [0, 1].map((axis) => ids.reduce((sum, id) => sum + point(state, id).screen[axis], 0) / ids.length);

/** Fails unless the picture at a place shows other marks than the picture without: that many of each kind. */
async function shows(page, place, marks, name) {
  await pointAway(page);
  const plain = await picture(page);
  await page.mouse.move(...place);
  await untilInspect(page, ({ marked }) => Object.entries(marks).every(([kind, count]) => marked[kind] === count), { timeout: 10_000 });
  const marked = await picture(page);
  assert.notDeepEqual(marked.data, plain.data, `${name} is in the picture`);
  if (process.env.PICTURES) await page.screenshot({ path: `${process.env.PICTURES}/${name}${process.env.DARK ? "-dark" : ""}.png` });
}

test("a sheet shows its skin over the curve, a sweep over the second curve", async () => {
  await withDocument(twoRings, async (page, state) => {
    await page.keyboard.press("s");
    await shows(page, onCurve(state, 1), { skins: 1 }, "sheet");
    await page.keyboard.press("w");
    await page.mouse.click(...onCurve(state, 1));
    await untilInspect(page, ({ underWay }) => underWay);
    await shows(page, onCurve(state, 2), { skins: 1, lines: 24 }, "sweep");
  }, options);
});

test("a crease is drawn sharp before it is made and soft before it is smoothed", async () => {
  await withDocument(ringedDisc, async (page, state) => {
    await page.keyboard.press("k");
    await shows(page, between(state, 5, 6, 7, 8), { edges: 1, soft: 0, tinted: 1, skins: 0 }, "crease-region");
    await shows(page, onCurve(state, 2), { edges: 1, soft: 0 }, "crease");
    await page.mouse.click(...onCurve(state, 2));
    const creased = await atRest(page, ({ act }) => act === "Crease");
    await shows(page, onCurve(creased, 2), { edges: 1, soft: 1 }, "smooth");
    // At a rim alone there is nothing to crease and nothing to smooth.
    await page.mouse.move(...onCurve(creased, 1));
    await untilInspect(page, ({ hover, marked }) => hover === "curve 1" && marked.edges === 0);
  }, options);
});

test("what would be split off drifts away, by region and by curve", async () => {
  await withDocument(ringedDisc, async (page, state) => {
    await page.keyboard.press("x");
    await shows(page, between(state, 5, 6, 7, 8), { edges: 1, tinted: 1, skins: 1 }, "split-region");
    await shows(page, onCurve(state, 2), { edges: 1, skins: 1 }, "split-curve");
  }, options);
});

test("the parts that a trim keeps are tinted up to the line in which the surfaces meet", async () => {
  await withDocument(domeThroughDisc, async (page, state) => {
    const top = point(state, 9).screen.map((value, axis) => value + [0, 6][axis]);
    const rim = onCurve(state, 1);
    const border = rim.map((value, axis) => value + 0.12 * (between(state, 1, 2, 3, 4)[axis] - value));
    await page.keyboard.press("t");
    await page.mouse.click(...top);
    await untilInspect(page, ({ underWay }) => underWay);
    await shows(page, border, { skins: 2, tinted: 0, lines: 1 }, "trim");
  }, options);
});

test("a tube is shown with its skin", async () => {
  await withDocument(bowlOverDisc, async (page) => {
    await page.keyboard.press("m");
    await pointAway(page);
    const plain = await picture(page);
    await page.keyboard.press("Enter");
    await untilInspect(page, ({ marked }) => marked.skins === 1);
    await drawn(page);
    assert.notDeepEqual((await picture(page)).data, plain.data);
    if (process.env.PICTURES) await page.screenshot({ path: `${process.env.PICTURES}/merge${process.env.DARK ? "-dark" : ""}.png` });
  }, options);
});
