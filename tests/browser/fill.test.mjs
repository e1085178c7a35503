// Fills by real pointer events: the loop under the pointer, one loop, all loops, what is chosen of them, ribbons of a file, seams.

import assert from "node:assert/strict";
import { readFile } from "node:fs/promises";
import { test } from "node:test";
import { atRest, documentOf, drawn, point, pointAway, withDocument } from "./support/model.mjs";
import { inspect, until, untilInspect } from "./support/page.mjs";
import { hexagon, pentagon, twoLoops } from "./support/loops.mjs";

const textOf = (page, id) => page.evaluate((id) => document.getElementById(id).textContent, id);

/** The middle of a curve in the picture. */
function middle(state, id) {
  const { screen } = state.curves.find((curve) => curve.id === id);
  return screen[Math.floor(screen.length / 2)];
}

/** Half way between two points in the picture: on a curve between them that is nearly straight there, and on no point. */
const between = (state, ...ids) => [0, 1].map((axis) => ids.reduce((sum, id) => sum + point(state, id).screen[axis] / ids.length, 0));

test("a loop is shown under the pointer and filled by a click; how it is filled can be chosen before and after", async () => {
  await withDocument(pentagon(), async (page, opened) => {
    await page.keyboard.press("f");
    await untilInspect(page, ({ tool }) => tool === "fill");
    await page.mouse.move(...between(opened, 6, 2));
    const over = await untilInspect(page, ({ hover, marked }) => hover === "curve 1" && marked.lines >= 5 && marked.skins === 1);
    assert.equal(over.document, opened.document, "pointing changes nothing");
    await drawn(page);
    if (process.env.PICTURES) await page.screenshot({ path: `${process.env.PICTURES}/fill.png` });
    await page.locator("#new-fill-degree").selectOption({ label: "4" });
    await page.mouse.click(...between(opened, 6, 2));
    const filled = await atRest(page, ({ act }) => act === "Fill");
    const { fills } = await documentOf(page);
    assert.deepEqual(Object.keys(fills), ["1"]);
    assert.deepEqual(fills[1].sides.map(({ curve }) => curve).sort(), [1, 2, 3, 4, 5]);
    assert.equal(fills[1].style.degree, 4);
    assert.deepEqual(filled.surfaces.map(({ kind }) => kind), ["Fill"]);
    await drawn(page);

    // The same loop is filled already: the hint says so before a click, and a click changes nothing.
    await page.mouse.move(...between(opened, 10, 1));
    await untilInspect(page, ({ hover }) => hover === "curve 5");
    await until(page, () => /^The loop at curve 5 is filled already\.$/.test(document.getElementById("hint").textContent), undefined, { timeout: 5000 });
    await page.mouse.click(...between(opened, 10, 1));
    const refused = await untilInspect(page, ({ toast }) => toast?.startsWith("Fill: the loop at curve 5"));
    assert.equal(refused.document, filled.document);
    await page.keyboard.press("Escape");
    await untilInspect(page, ({ tool }) => tool === "shape");

    // Its properties: the sides, the figures, another style.
    await page.locator('#scene-list [data-subject="surface 1"]').click();
    await until(page, () => /5 sides of degree 4/.test(document.getElementById("fill-figures").textContent));
    assert.match(await textOf(page, "fill-sides"), /Side 1 · curve \dfair planes/);
    assert.equal((await inspect(page)).netEdges, 5 * (4 + 4 + 5), "two rows of each ribbon, and legs between them");
    await page.locator("#fill-net").selectOption({ label: "Whole" });
    await atRest(page, ({ netEdges }) => netEdges === 5 * 210);
    await drawn(page);
    if (process.env.PICTURES) await page.screenshot({ path: `${process.env.PICTURES}/fill-net.png` });
    await page.locator("#undo").click();
    await atRest(page, ({ netEdges }) => netEdges === 65);
    await page.locator("#fill-join").selectOption({ label: "Positions" });
    await atRest(page, (state) => JSON.parse(state.document).fills[1].style.join === "position");
    assert.equal((await documentOf(page)).fills[1].style.join, "position");
    await page.locator("#fill-interior").selectOption({ label: "Harmonic" });
    await atRest(page, (state) => JSON.parse(state.document).fills[1].style.interior === "harmonic");
    await page.locator("#fill-resolution").fill("65");
    await page.locator("#fill-resolution").press("Enter");
    await until(page, () => /from 1 to 64/.test(document.getElementById("number-error").textContent));
    await page.locator("#fill-resolution").fill("8");
    await page.locator("#fill-resolution").press("Enter");
    await atRest(page, (state) => JSON.parse(state.document).fills[1].style.resolution === 8);
    for (let acts = 4; acts > 0; acts -= 1) {
      const { document } = await inspect(page);
      await page.locator("#undo").click();
      await atRest(page, (state) => state.document !== document);
    }
    assert.equal((await inspect(page)).document, opened.document, "all of it is taken back");
  });
});

test("corners are picked on a closed curve; a refusal keeps them, Escape and Backspace let go", async () => {
  await withDocument(hexagon(), async (page, opened) => {
    const place = (id) => point(opened, id).screen;
    const hint = (text) => until(page, (text) => document.getElementById("hint").textContent.includes(text), text, { timeout: 5000 });
    await page.keyboard.press("f");
    await untilInspect(page, ({ tool }) => tool === "fill");
    await page.mouse.move(...place(2));
    await untilInspect(page, ({ hover }) => hover === "point 2");
    await hint("or points as corners");
    for (const id of [1, 2, 3]) await page.mouse.click(...place(id));
    const three = await untilInspect(page, ({ marked, underWay }) => marked.points === 3 && underWay);
    assert.equal(three.document, opened.document, "picking changes nothing");
    await hint("Enter fills between these corners");
    // One is let go by a click, one by Backspace, all by Escape.
    await page.mouse.click(...place(2));
    await untilInspect(page, ({ marked }) => marked.points === 2);
    await hint("three or more");
    await page.keyboard.press("Enter");
    await untilInspect(page, ({ toast }) => toast?.includes("at least three corners"));
    await page.keyboard.press("Backspace");
    await untilInspect(page, ({ marked }) => marked.points === 1);
    await page.keyboard.press("Escape");
    await untilInspect(page, ({ tool, marked }) => tool === "fill" && marked.points === 0);

    // The curve does not turn at its points: tangent planes cannot be met there, positions can.
    for (const id of [1, 3, 4, 6]) await page.mouse.click(...place(id));
    await page.keyboard.press("Enter");
    const refused = await untilInspect(page, ({ toast }) => toast?.includes("the loop turns by"));
    assert.equal(refused.marked.points, 4, "they are still there");
    await page.locator("#new-fill-join").selectOption({ label: "Positions" });
    await page.mouse.click(...middle(opened, 1));
    const filled = await atRest(page, ({ act }) => act === "Fill");
    assert.deepEqual(JSON.parse(filled.document).fills[1].sides.map(({ from }) => from).sort(), [1, 3, 4, 6]);
    await untilInspect(page, ({ marked, tool }) => marked.points === 0 && tool === "fill");
    await page.locator("#undo").click();
    await atRest(page, ({ document }) => document === opened.document);
  });
});

test("a rim that a bulging patch hides is taken where none is in sight, by the tool that is about rims", async () => {
  const bulging = pentagon("Bulge");
  const side = (k) => ({ curve: k, from: k, to: (k % 5) + 1 });
  bulging.fills = { 1: { sides: [1, 2, 3, 4, 5].map(side) } };
  bulging.displacements = { 1: { items: [{ foot: { at: [0, 0, 0.2] }, by: [0, 0, 1.6], range: 0.5 }] } };
  await withDocument(bulging, async (page, opened) => {
    // The curve whose middle is farthest from the eye lies behind the bulge.
    const far = ({ at }) => Math.hypot(...at[Math.floor(at.length / 2)].map((x, axis) => x - opened.camera.eye[axis]));
    const { id } = opened.curves.reduce((a, b) => (far(b) > far(a) ? b : a));
    await page.mouse.move(...middle(opened, id));
    await untilInspect(page, ({ hover }) => hover === "surface 1");
    await page.keyboard.press("f");
    const over = await untilInspect(page, ({ hover }) => hover === `curve ${id}`);
    assert.equal(over.document, opened.document);
    await until(page, (id) => document.getElementById("hint").textContent === `The loop at curve ${id} is filled already.`, id, { timeout: 5000 });
  });
});

test("all loops of a network are filled at once, and the report tells how they meet", async () => {
  await withDocument(twoLoops(), async (page, opened) => {
    await page.keyboard.press("f");
    await page.mouse.move(...middle(opened, 1));
    await untilInspect(page, ({ hover }) => hover === "curve 1");
    await page.keyboard.press("Enter");
    const filled = await atRest(page, ({ act }) => act === "Fill all");
    assert.equal(filled.surfaces.length, 2);
    await page.locator("#seams summary").click();
    await until(page, () => document.querySelectorAll("#seam-list li").length === 1);
    const told = await textOf(page, "seam-list");
    const [, gap, angle] = /Surfaces 1 and 2 · curve \d.*gap (\S+) · (\S+)°/.exec(told) ?? assert.fail(told);
    assert.ok(Number(gap) < 1e-6, `they have the same boundary: ${told}`);
    assert.ok(Number(angle) < 1, `and nearly the same planes: ${told}`);
    await page.locator("#seam-list button").hover();
    await untilInspect(page, ({ marked }) => marked.lines === 1);
    await pointAway(page);
    await untilInspect(page, ({ marked }) => marked.lines === 0);

    // The button does the same for all curves; now there is nothing left to fill.
    await page.locator("#fill-all").click();
    const refused = await untilInspect(page, ({ toast }) => toast?.startsWith("Fill all:"));
    assert.match(refused.toast, /no loop of curves left/);
    assert.equal(refused.document, filled.document);
  });
});

test("a file of ribbons is filled; ribbons that do not fit are refused by side and point, and one click makes them fit", async () => {
  const fixture = JSON.parse(await readFile(new URL("../fixtures/s-patch-5-sided-cubic.json", import.meta.url), "utf8"));
  const file = (name, value) => ({ name, mimeType: "application/json", buffer: Buffer.from(JSON.stringify(value)) });
  await withDocument(pentagon(), async (page, opened) => {
    await page.locator("#file").setInputFiles(file("ribbons.json", fixture));
    const filled = await atRest(page, ({ act }) => act === "Fill");
    const given = (await documentOf(page)).fills[1].ribbons;
    assert.deepEqual(given.map(({ row0 }) => row0), fixture.ribbons.map(({ row0 }) => row0));
    await page.locator("#undo").click();
    await atRest(page, ({ document }) => document === opened.document);

    const twisted = structuredClone(fixture);
    twisted.ribbons[1].row1[1][2] += 0.4;
    await page.locator("#file").setInputFiles(file("twisted.json", twisted));
    const refused = await untilInspect(page, ({ banners }) => banners.some((text) => /side 1: point 1 of row 1/.test(text)));
    assert.equal(refused.document, opened.document, "the model is as it was");
    await page.locator('[data-command="make-compatible"]').click();
    const made = await atRest(page, (state) => state.act === "Fill" && state.document !== filled.document);
    const moved = JSON.parse(made.document).fills[1].ribbons[1].row1[1][2] - fixture.ribbons[1].row1[1][2];
    assert.ok(Math.abs(moved - 0.2) < 1e-9, `the twist point goes half way: ${moved}`);
    assert.deepEqual(made.banners, []);

    await page.locator("#file").setInputFiles(file("bad.json", { ribbons: [{ row0: [[0, 0]] }] }));
    const bad = await untilInspect(page, ({ banners }) => banners.length > 0);
    assert.match(bad.banners[0], /The ribbons were not opened: the ribbons of patch 0/);
    assert.equal(bad.document, made.document);
  });
});
