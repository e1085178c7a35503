// What tests ask of the model and its picture again and again.

import assert from "node:assert/strict";
import { inspect, until, untilInspect, withPage } from "./page.mjs";
import { pixels } from "./pixels.mjs";
import { drag } from "./pointer.mjs";

/** Wide enough for the layout with panels at the sides, small enough for rendering by software. */
export const wide = { width: 900, height: 560 };

/** Waits until a document is there, nothing is asked of the solver and nothing relaxes; returns the state. */
export function atRest(page, predicate = () => true, { timeout = 90_000 } = {}) {
  const rests = (state) => state?.document != null && state.settled && !state.camera.flying && predicate(state);
  return untilInspect(page, rests, { timeout });
}

/** Opens a document from an address; the body gets the page and its state at rest. Options as those of `withPage`. */
export function withDocument(document, body, options = {}) {
  const extra = { "/spec.json": { type: "application/json", body: JSON.stringify(document) } };
  return withPage({ viewport: wide, extra, query: "?spec=spec.json", ...options }, async (page) => {
    const opened = await atRest(page, ({ name }) => name === document.name);
    await body(page, opened);
  });
}

/** Waits until the status line says this of the topology. */
export function topology(page, text) {
  return until(page, (text) => document.getElementById("figure-topology").textContent === text, text, { timeout: 5000 });
}

/** A control point of a state by its identity. */
export function point(state, id) {
  const found = state.points.find((entry) => entry.id === id);
  assert.ok(found, `there is a point ${id}`);
  return found;
}

/** The points of a state that another one does not have. */
export function newPoints(state, before) {
  return state.points.filter(({ id }) => !before.points.some((entry) => entry.id === id));
}

/** How far apart two places of the same dimension are. */
export function distance(a, b) {
  return Math.hypot(...a.map((value, index) => value - b[index]));
}

/** Fails unless the canvas itself, not a panel over it, gets what happens at these places. */
export async function assertOnCanvas(page, ...places) {
  for (const place of places) {
    const id = await page.evaluate(([x, y]) => document.elementFromPoint(x, y)?.id, place);
    assert.equal(id, "view", `the canvas is uncovered at ${place}`);
  }
}

/** Moves the pointer to a corner of the canvas where nothing is: no hover, no tip. */
export async function pointAway(page) {
  await page.mouse.move(80, 300);
  await untilInspect(page, (state) => state.hover === null);
}

/** The middle of the picture, where no panel, welcome or toast lies, once everything known has been drawn. */
export async function picture(page) {
  await drawn(page);
  const { width, height } = page.viewportSize();
  const whole = await pixels(page, undefined);
  const [left, top, right, bottom] = [60, 104, width - 256, height - 140];
  const part = { width: right - left, height: bottom - top, data: Buffer.alloc(4 * (right - left) * (bottom - top)) };
  for (let y = 0; y < part.height; y += 1) {
    const start = 4 * ((top + y) * whole.width + left);
    whole.data.copy(part.data, 4 * y * part.width, start, start + 4 * part.width);
  }
  return part;
}

/** Waits for the first picture, then for two display ticks: what was due has been drawn. */
export async function drawn(page) {
  // The model may be at rest long before there is a graphics device.
  await untilInspect(page, ({ gpu, pictures }) => gpu === "ready" && pictures > 0);
  const ticks = () => new Promise((done) => requestAnimationFrame(() => requestAnimationFrame(() => done(true))));
  return page.evaluate(ticks);
}

/** Clicks a command of a menu as a hand does: opens the menu, then chooses. */
export async function choose(page, menu, command) {
  await page.locator(`#${menu}-button`).click();
  await page.locator(`#${menu}-menu [data-command="${command}"]`).click();
}

/** The document after the last act, read. */
export async function documentOf(page) {
  return JSON.parse((await inspect(page)).document);
}

/** A place of the surface far from all controls, and where to drag it. */
export function onBareSurface(state) {
  const corners = [3, 4, 6, 7].map((id) => point(state, id).screen);
  const from = [0, 1].map((axis) => corners.reduce((sum, place) => sum + place[axis], 0) / corners.length);
  for (const { screen } of state.points) assert.ok(distance(screen, from) > 30);
  return [from, [from[0] + 15, from[1] - 80]];
}

/** Pulls point 7 up a little, so that the document is none that the page could guess. */
export async function pulled(page) {
  const before = await atRest(page);
  const from = point(before, 7).screen;
  await drag(page, from, [from[0] + 3, from[1] - 20]);
  return atRest(page, (state) => state.document !== before.document);
}

/** Waits for a banner; some go by themselves. */
export function said(page, text) {
  return untilInspect(page, ({ banners }) => banners.some((banner) => text.test(banner)));
}

/** Fails unless the document is the same and the shape has the same energy. */
export function assertSame(after, before) {
  assert.equal(after.document, before.document, "the document is the last committed one");
  const ratio = after.figures.energy / before.figures.energy;
  assert.ok(Math.abs(ratio - 1) < 0.02, `the shape is the same but for ${ratio}`);
}
