// From nothing to a surface, to a file and back.

import assert from "node:assert/strict";
import { readFile } from "node:fs/promises";
import { test } from "node:test";
import { assertOnCanvas, atRest, choose, distance, newPoints, point, wide } from "./support/model.mjs";
import { inspect, untilInspect, withPage } from "./support/page.mjs";
import { drag } from "./support/pointer.mjs";

const corners = [[300, 210], [560, 190], [590, 390], [280, 370]];

test("four clicks and one make a curve, another a surface; it can be pulled", async () => {
  await withPage({ viewport: wide }, async (page) => {
    const surface = await sheet(page);
    assert.equal(surface.surfaces.length, 1);
    const { summary } = surface.surfaces[0];
    assert.deepEqual(summary, { euler: 1, boundaries: 1, components: 1, orientable: true, genus: 0 });
    assert.ok(Math.abs(surface.figures.energy) < 0.01, `a flat sheet costs nothing, not ${surface.figures.energy}`);

    await page.locator("#tool-shape").click();
    const from = [430, 290];
    const to = [435, 200];
    await assertOnCanvas(page, from, to);
    await drag(page, from, to);
    const after = await atRest(page, (state) => state.document !== surface.document);
    const [made, ...more] = newPoints(after, surface);
    assert.deepEqual(more, []);
    assert.equal(made.role, "Surface");
    assert.ok(distance(made.screen, to) < 2, `it went along: ${made.screen} at ${to}`);
    assert.ok(after.figures.energy > 0.5, `a bump costs energy: ${after.figures.energy}`);
    assert.equal(after.surfaces[0].summary.euler, 1);

    // All the way back: bump, sheet, curve, the new document, and what was there before.
    for (const gone of [["points", 4], ["surfaces", 0], ["curves", 0]]) {
      await page.keyboard.press("Control+z");
      await atRest(page, (state) => state[gone[0]].length === gone[1]);
    }
    await page.keyboard.press("Control+z");
    await atRest(page, (state) => state.name === "Raised disc" && state.surfaces.length === 1);
  });
});

test("a curve through old points and new ones is one step of undo", async () => {
  await withPage({ viewport: wide }, async (page) => {
    const before = await atRest(page);
    const [first, second] = [1, 3].map((id) => point(before, id).screen);
    await page.keyboard.press("c");
    const clicks = [first, [120, 120], second, [560, 520]];
    await assertOnCanvas(page, ...clicks);
    for (const [index, place] of clicks.entries()) {
      await page.mouse.click(...place);
      await untilInspect(page, (state) => state.corners === index + 1);
    }
    await page.mouse.click(...first);
    const drawn = await atRest(page, ({ curves }) => curves.length === 2);
    assert.equal(drawn.points.length, before.points.length + 2);
    const { through, closed } = JSON.parse(drawn.document).curves[2];
    assert.ok(closed && through.length === 4 && [1, 3].every((id) => through.includes(id)), `through ${through}`);
    assert.equal(drawn.undo, "Curve");

    await page.keyboard.press("Control+z");
    const back = await atRest(page, ({ curves }) => curves.length === 1);
    assert.equal(back.document, before.document, "curve and new points are gone at once");
    assert.equal(back.undo, before.undo);
    await page.keyboard.press("Control+Shift+Z");
    assert.equal((await atRest(page, ({ curves }) => curves.length === 2)).document, drawn.document);
  });
});

test("two curves are swept by two clicks; the skin can be pulled", async () => {
  await withPage({ viewport: wide }, async (page) => {
    await atRest(page);
    await choose(page, "file", "new");
    await atRest(page, ({ points }) => points.length === 0);
    const middle = [430, 290];
    const inner = corners.map((corner) => [0, 1].map((axis) => middle[axis] + 0.4 * (corner[axis] - middle[axis])));
    await closedCurve(page, corners, 1);
    const drawn = await closedCurve(page, inner, 2);
    assert.equal(drawn.points.length, 8);
    const [outside, inside] = [corners, inner].map((ends, index) => onCurve(drawn.curves[index], ends));

    await page.keyboard.press("w");
    await page.mouse.click(...outside);
    await untilInspect(page, ({ selection, toast }) => selection === null && toast === null);
    await page.mouse.click(...outside);
    const refused = await untilInspect(page, ({ toast }) => toast?.includes("two different curves"));
    assert.equal(refused.document, drawn.document, "a curve is not swept to itself");
    await page.mouse.click(...inside);
    const swept = await atRest(page, ({ surfaces }) => surfaces.length === 1);
    const { summary } = swept.surfaces[0];
    assert.deepEqual(summary, { euler: 0, boundaries: 2, components: 1, orientable: true, genus: 0 });
    assert.ok(Math.abs(swept.figures.energy) < 0.01, `a flat ring costs nothing, not ${swept.figures.energy}`);
    assert.equal(swept.undo, "Sweep");

    // Up with the inner curve: a crater's wall.
    await page.keyboard.press("v");
    const from = swept.points.find(({ screen }) => distance(screen, inner[0]) < 2).screen;
    const to = [from[0] - 5, from[1] - 60];
    await assertOnCanvas(page, from, to);
    await drag(page, from, to);
    const pulled = await atRest(page, (state) => state.document !== swept.document);
    assert.ok(pulled.points.some(({ screen }) => distance(screen, to) < 2));
    assert.ok(pulled.figures.energy > 0.5);
    for (const surfaces of [1, 0]) {
      await page.keyboard.press("Control+z");
      await atRest(page, (state) => state.surfaces.length === surfaces && state.undo !== pulled.undo);
    }
    assert.equal((await inspect(page)).document, drawn.document);
  });
});

test("Enter ends an open curve, Backspace takes a corner back, a sheet over it is refused with a reason", async () => {
  await withPage({ viewport: wide }, async (page) => {
    await atRest(page);
    await choose(page, "file", "new");
    const empty = await atRest(page, ({ points }) => points.length === 0);
    await page.keyboard.press("c");
    for (const corner of corners) await page.mouse.click(...corner);
    await untilInspect(page, (state) => state.corners === 4);
    await page.keyboard.press("Backspace");
    await untilInspect(page, (state) => state.corners === 3);
    await page.keyboard.press("Enter");
    const drawn = await atRest(page, ({ curves }) => curves.length === 1);
    assert.equal(drawn.curves[0].closed, false);
    assert.equal(drawn.points.length, 3);
    assert.notEqual(drawn.document, empty.document);

    await page.keyboard.press("s");
    await page.mouse.click(...drawn.curves[0].screen[1]);
    const refused = await untilInspect(page, ({ toast }) => toast?.includes("only a closed curve can be skinned"));
    assert.equal(refused.document, drawn.document);
    assert.equal(refused.surfaces.length, 0);
  });
});

test("a saved file is the document; it opens again; a damaged one does not", async () => {
  await withPage({ viewport: wide }, async (page) => {
    const made = await sheet(page);
    const [saved] = await Promise.all([page.waitForEvent("download", { timeout: 60_000 }), page.keyboard.press("Control+s")]);
    assert.match(saved.suggestedFilename(), /\.ductile\.json$/);
    const text = await readFile(await saved.path(), "utf8");
    assert.deepEqual(JSON.parse(text), JSON.parse(made.document));

    await choose(page, "file", "new");
    await atRest(page, ({ points }) => points.length === 0);
    await page.locator("#file").setInputFiles(file("again.ductile.json", text));
    const again = await atRest(page, ({ surfaces }) => surfaces.length === 1);
    assert.equal(again.document, made.document, "the file brings the very document back");
    assert.deepEqual(again.surfaces[0].summary, made.surfaces[0].summary);

    await dropped(page, "damaged.json", text.slice(0, text.length / 2));
    const kept = await untilInspect(page, ({ banners }) => banners.length > 0);
    assert.match(kept.banners.join(), /line \d+.*The model on the screen is as it was/);
    assert.equal(kept.document, made.document);
    assert.equal(kept.surfaces.length, 1);

    await dropped(page, "large.json", " ".repeat((4 << 20) + 1));
    const large = await untilInspect(page, ({ banners }) => banners.some((line) => line.includes("large.json")));
    assert.match(large.banners.join(), /the limit is 4194304.*The model on the screen is as it was/);
    assert.equal((await atRest(page)).document, made.document);

    const other = JSON.parse(text);
    other.name = "Dropped";
    await dropped(page, "other.json", JSON.stringify(other));
    const opened = await atRest(page, ({ name }) => name === "Dropped");
    assert.deepEqual(opened.banners, [], "what was wrong before is over");
    assert.deepEqual(JSON.parse(opened.document), other);
  });
});

test("an exported OBJ has the vertices and faces that are shown", async () => {
  await withPage({ viewport: wide }, async (page) => {
    const state = await atRest(page);
    const coming = page.waitForEvent("download", { timeout: 60_000 });
    await choose(page, "file", "export-obj");
    const exported = await coming;
    assert.match(exported.suggestedFilename(), /\.obj$/);
    const lines = (await readFile(await exported.path(), "utf8")).split("\n");
    const vertices = lines.filter((line) => line.startsWith("v "));
    const faces = lines.filter((line) => line.startsWith("f "));
    const [surface] = state.surfaces;
    assert.equal(vertices.length, surface.vertex_count);
    assert.equal(faces.length, surface.index_count / 3);
    for (const line of vertices) assert.match(line, /^v( -?\d+(\.\d+)?(e-?\d+)?){3}$/);
    const indices = faces.flatMap((line) => line.slice(2).split(" ").map((part) => Number.parseInt(part, 10)));
    assert.equal(Math.min(...indices), 1);
    assert.equal(Math.max(...indices), vertices.length);
    const heights = vertices.map((line) => Number(line.split(" ")[3]));
    assert.ok(Math.max(...heights) >= 0.5, "the raised disc is raised");
  });
});

test("every example opens and rests", async () => {
  const topologies = {
    disc: [1, 1], saddle: [1, 1], cylinder: [0, 2], ball: [2, 0], "raised-disc": [1, 1],
    torus: [0, 0], "party-hat": [-2, 4], "capped-cylinder": [2, 0], "glued-cylinders": [0, 2],
    handle: [-2, 0], "klein-mug": [0, 0], "three-handles": [-4, 0],
    "moebius-strip": [0, 1], spout: [1, 1], "bored-ball": [0, 0],
    "torus-cage": [0, 0], trebol: [-4, 0], icosahedron: [2, 0],
    "six-sided": [1, 1], "connected-patches": [1, 1], "lobed-ring": [0, 0],
  };
  await withPage({ viewport: wide }, async (page) => {
    let before = await atRest(page);
    const names = await page.locator("#examples button").evaluateAll((buttons) => buttons.map((b) => b.dataset.subject));
    assert.deepEqual([...names].sort(), Object.keys(topologies).sort());
    for (const name of Object.keys(topologies)) {
      await page.locator("#file-button").click();
      await page.locator(`#examples [data-subject="${name}"]`).click();
      const openings = before.openings;
      const after = await atRest(page, (state) => state.openings === openings + 1);
      const [{ summary }] = after.surfaces;
      assert.deepEqual([summary.euler, summary.boundaries], topologies[name], name);
      const most = { handle: 195, "klein-mug": 150, "three-handles": 240, torus: 90, "party-hat": 75, "bored-ball": 1050 }[name] ?? 60;
      assert.ok(after.figures.energy > -1e-6 && after.figures.energy < most, `${name} has energy ${after.figures.energy}`);
      before = after;
    }
  });
});

/** New document, a closed curve through four places, a sheet over it. */
async function sheet(page) {
  await atRest(page);
  await choose(page, "file", "new");
  const empty = await atRest(page, (state) => state.points.length === 0);
  assert.equal(empty.surfaces.length, 0);
  const drawn = await closedCurve(page, corners, 1);
  assert.equal(drawn.points.length, 4);
  await page.locator("#tool-sheet").click();
  await page.mouse.click(...onCurve(drawn.curves[0], corners));
  const made = await atRest(page, (state) => state.surfaces.length === 1);
  assert.equal((await inspect(page)).act, made.act);
  return made;
}

/** Clicks places one after the other and the first again; returns the state with so many curves. */
async function closedCurve(page, places, count) {
  await page.locator("#tool-curve").click();
  await assertOnCanvas(page, ...places);
  for (const [index, place] of places.entries()) {
    await page.mouse.click(...place);
    await untilInspect(page, (state) => state.corners === index + 1);
  }
  await page.mouse.click(...places[0]);
  const drawn = await atRest(page, (state) => state.curves.length === count);
  assert.equal(drawn.curves[count - 1].closed, true);
  for (const place of places) {
    const nearest = Math.min(...drawn.points.map(({ screen }) => distance(screen, place)));
    assert.ok(nearest < 1.5, `a point is where ${place} was clicked, not ${nearest} pixels away`);
  }
  return drawn;
}

/** A place on a curve away from its points. */
function onCurve(curve, ends) {
  const free = curve.screen.find((at) => ends.every((corner) => distance(at, corner) > 20));
  assert.ok(free, "the curve has a place away from its points");
  return free;
}

function file(name, text) {
  return { name, mimeType: "application/json", buffer: Buffer.from(text) };
}

/** Drops a file on the canvas, as a file manager does. */
async function dropped(page, name, text) {
  const dataTransfer = await page.evaluateHandle(([called, content]) => {
    const transfer = new DataTransfer();
    transfer.items.add(new File([content], called, { type: "application/json" }));
    return transfer;
  }, [name, text]);
  await page.dispatchEvent("#view", "dragover", { dataTransfer });
  assert.equal(await page.locator("#drop-target").isVisible(), true);
  await page.dispatchEvent("#view", "drop", { dataTransfer });
  assert.equal(await page.locator("#drop-target").isVisible(), false);
}
