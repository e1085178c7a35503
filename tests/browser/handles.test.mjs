// The Ribbon tool and its green handles by real pointer events: what it marks, what a click prescribes, what a drag turns, the ways back.

import assert from "node:assert/strict";
import { test } from "node:test";
import { assertOnCanvas, atRest, distance, documentOf, drawn, point, pointAway, wide, withDocument } from "./support/model.mjs";
import { inspect, untilInspect, withPage } from "./support/page.mjs";
import { twoRings } from "./support/rings.mjs";

const ribbonOf = (state) => JSON.parse(state.document).surfaces[1].ribbons?.[1]?.cross;
const normalOf = (state) => JSON.parse(state.document).surfaces[1].normals?.[5];

/** Takes the tool and waits until it is in hand. */
async function take(page, key, tool) {
  await page.keyboard.press(key);
  await untilInspect(page, (state) => state.tool === tool);
}

/** A place of a curve in plain sight and clear of points, at which the tool in hand would take it. */
async function onCurve(page, id) {
  const state = await inspect(page);
  const { screen } = state.curves.find((curve) => curve.id === id);
  const clear = ([x, y]) => state.points.every(({ screen: [px, py] }) => Math.hypot(px - x, py - y) > 24);
  for (const place of screen.filter(clear).sort((a, b) => b[1] - a[1])) {
    await page.mouse.move(...place);
    await drawn(page);
    if ((await inspect(page)).hover === `curve ${id}`) return place;
  }
  return assert.fail(`curve ${id} is nowhere in sight`);
}

/** Presses on the end of a handle and pulls it to a place; the button stays down. */
async function pull(page, from, to) {
  await assertOnCanvas(page, from, to);
  await page.mouse.move(...from);
  await page.mouse.down();
  for (let step = 1; step <= 8; step += 1) {
    await page.mouse.move(...[0, 1].map((axis) => from[axis] + ((to[axis] - from[axis]) * step) / 8));
  }
  return untilInspect(page, ({ held, handles }) => held !== null && handles.some((end) => distance(end, to) < 2));
}

async function picture(page, name) {
  if (process.env.PICTURES) await page.screenshot({ path: `${process.env.PICTURES}/${name}.png` });
}

test("a rim is picked, its strip is shown, and a handle turns it under the pointer as one act", async () => {
  const context = { colorScheme: process.env.DARK ? "dark" : "light" };
  await withPage({ viewport: wide, context }, async (page) => {
    const before = await atRest(page);
    await take(page, "r", "ribbon");
    const place = await onCurve(page, 1);
    const over = await untilInspect(page, ({ marked }) => marked.strips === 1);
    assert.equal(over.document, before.document, "pointing changes nothing");
    assert.deepEqual(over.handles, []);
    await picture(page, "ribbon-hover");
    await page.mouse.click(...place);
    const told = await atRest(page, ({ act, selection }) => act === "Ribbon" && selection === "curve 1");
    assert.deepEqual(Object.keys(ribbonOf(told)), ["1", "2", "3", "4"]);
    assert.deepEqual([told.handles.length, told.marked.strips, told.undo], [4, 1, "Ribbon"]);
    // A second click on the same curve adds nothing.
    await page.mouse.click(...place);
    await pointAway(page);
    await picture(page, "ribbon-handles");

    // The lowest handle in the picture, pulled up.
    const index = told.handles.map(([, y]) => y).reduce((best, y, k, all) => (y > all[best] ? k : best), 0);
    const end = told.handles[index];
    const to = [end[0] + 10, end[1] - 46];
    const shape = told.curves[0].screen;
    const live = await pull(page, end, to);
    assert.equal(live.document, told.document, "a drag in progress is not committed");
    await picture(page, "ribbon-drag");
    await page.keyboard.press("Escape");
    const back = await atRest(page, ({ held }) => held === null);
    await page.mouse.up();
    assert.equal(back.document, told.document, "Escape puts the direction back");
    assert.ok(distance(back.handles[index], end) < 1 && distance(back.curves[0].screen[1], shape[1]) < 0.5);

    await pull(page, end, to);
    await page.mouse.up();
    const turned = await atRest(page, ({ document }) => document !== told.document);
    assert.equal(turned.undo, "Ribbon");
    const [was, is] = [told, turned].map(ribbonOf);
    const changed = Object.keys(was).filter((id) => distance(was[id], is[id]) > 1e-9);
    assert.deepEqual(changed, [String(index + 1)], "the others stay as they were");
    assert.ok(distance(was[index + 1], is[index + 1]) > 0.15, `${was[index + 1]} and ${is[index + 1]}`);
    assert.ok(Math.abs(turned.figures.energy - told.figures.energy) > 1e-3, "the surface is another");
    await pointAway(page);
    await picture(page, "ribbon-turned");

    // It is taken back in two steps and done again, and the page keeps it.
    for (const [key, document] of [["z", told.document], ["z", before.document], ["y", told.document], ["y", turned.document]]) {
      await page.keyboard.press(`Control+${key}`);
      await atRest(page, (state) => state.document === document);
    }
    const { energy } = (await inspect(page)).figures;
    assert.ok(Math.abs(energy / turned.figures.energy - 1) < 1e-9, `${energy} for ${turned.figures.energy}`);
    await page.reload();
    const again = await atRest(page, ({ document }) => document === turned.document);
    assert.ok(Math.abs(again.figures.energy / turned.figures.energy - 1) < 0.02);
    await page.locator('#scene-list [data-subject="curve 1"]').click();
    await untilInspect(page, ({ tool, handles, marked }) => tool === "shape" && handles.length === 4 && marked.strips === 1);
  });
});

test("a point in a surface gets the normal that it has, whose handle turns it; the way back stands beside the hint", async () => {
  await withPage({ viewport: wide }, async (page) => {
    const before = await atRest(page);
    await take(page, "r", "ribbon");
    const top = point(before, 5).screen;
    await page.mouse.move(...top);
    await untilInspect(page, ({ hover }) => hover === "point 5");
    await page.mouse.click(...top);
    const told = await atRest(page, ({ act, selection }) => act === "Normal" && selection === "point 5");
    assert.equal(told.handles.length, 1);
    assert.ok(Math.abs(told.figures.energy / before.figures.energy - 1) < 1e-3, "it is the normal that the surface had");
    await picture(page, "normal-handle");
    const [end] = told.handles;
    const to = [end[0] + 40, end[1] + 12];
    await pull(page, end, to);
    await page.mouse.up();
    const turned = await atRest(page, ({ document }) => document !== told.document);
    assert.equal(turned.undo, "Normal");
    assert.ok(distance(normalOf(told), normalOf(turned)) > 0.2);
    const angle = ([x, y]) => Math.atan2(y - top[1], x - top[0]);
    assert.ok(Math.abs(angle(turned.handles[0]) - angle(to)) < 0.05, "the handle points where the hand was");
    await picture(page, "normal-turned");
    // Shape turns it as well; Escape puts that back.
    await take(page, "v", "shape");
    await pull(page, turned.handles[0], end);
    await page.keyboard.press("Escape");
    await page.mouse.up();
    await atRest(page, ({ held, document }) => held === null && document === turned.document);
    await take(page, "r", "ribbon");
    await page.locator("#option-free").click();
    const free = await atRest(page, (state) => normalOf(state) === undefined);
    assert.equal(free.document, before.document);
    await page.locator("#option-free").waitFor({ state: "hidden" });
    // From the keyboard: the tool takes the selected point.
    await page.locator("#view").focus();
    await page.keyboard.press("Space");
    await atRest(page, (state) => normalOf(state) !== undefined && state.handles.length === 1);
    await page.keyboard.press("Escape");
    await untilInspect(page, ({ tool }) => tool === "shape");
  });
});

test("a curve that no surface follows, and empty space, are refused with the reason", async () => {
  await withDocument(twoRings, async (page, opened) => {
    await take(page, "r", "ribbon");
    const { screen } = opened.curves[0];
    const place = screen.find(([x, y]) => opened.points.every(({ screen: [px, py] }) => Math.hypot(px - x, py - y) > 24));
    await page.mouse.move(...place);
    await drawn(page);
    assert.equal((await inspect(page)).hover, null, "what would be refused is not marked");
    await page.mouse.click(...place);
    await untilInspect(page, ({ toast }) => /^No fair surface follows this curve/.test(toast ?? ""));
    await page.mouse.click(120, 300);
    const state = await untilInspect(page, ({ toast }) => /^There is no curve here/.test(toast ?? ""));
    assert.equal(state.document, opened.document);
  });
});
