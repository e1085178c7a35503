// Cages in the page: placed, dragged by vertex, edge and face, extruded and split, taken back, sent as a link, imported.

import assert from "node:assert/strict";
import { test } from "node:test";
import { atRest, choose, distance, documentOf, drawn, picture, point, wide } from "./support/model.mjs";
import { inspect, open, untilInspect, withPage } from "./support/page.mjs";
import { difference } from "./support/pixels.mjs";
import { drag } from "./support/pointer.mjs";

const context = { permissions: ["clipboard-read", "clipboard-write"] };

/** An empty document with the Cage tool in hand. */
async function begun(page) {
  await atRest(page);
  await choose(page, "file", "new");
  await atRest(page, ({ points }) => points.length === 0);
  await page.keyboard.press("q");
  await untilInspect(page, ({ tool }) => tool === "cage");
}

/** Places a cage of that form in the middle of the picture. */
async function place(page, form) {
  await page.locator("#cage-form").selectOption({ label: form });
  const { points } = await inspect(page);
  await page.mouse.click(400, 290);
  const state = await atRest(page, (now) => now.act === "Cage" && now.points.length > points.length);
  await page.mouse.move(300, 500);
  return state;
}

/** The middle of some control points in the picture. */
function middleOf(state, ids) {
  return [0, 1].map((axis) => ids.reduce((sum, id) => sum + point(state, id).screen[axis] / ids.length, 0));
}

/** How far a place lies outside of the ball around a surface. */
function outside(state, at, id = 1) {
  const { centre, radius } = state.balls.find((ball) => ball.id === id);
  return distance(centre, at) - radius;
}

/** Hovers until the page says what is under the pointer. */
async function hover(page, place, named) {
  await page.mouse.move(...place);
  return untilInspect(page, ({ hover }) => named.test(hover ?? ""));
}

test("a cage is placed, its vertices, faces and edges are dragged and changed, and all of it is taken back", async () => {
  const session = await open({ viewport: wide, context });
  try {
    const { page } = session;
    await begun(page);
    const empty = await documentOf(page);
    const cube = await place(page, "Cube");
    assert.equal(cube.points.length, 8);
    assert.deepEqual(cube.surfaces.map(({ kind, summary }) => [kind, summary.euler]), [["Cage", 2]]);
    await drawn(page);

    // A vertex goes with the hand, and the surface with it, before the hand lets go.
    const toEye = ({ at }) => distance(at, cube.camera.eye);
    const top = cube.points.reduce((a, b) => (toEye(b) < toEye(a) ? b : a));
    await hover(page, top.screen, new RegExp(`^point ${top.id}$`));
    const to = [top.screen[0] + 30, top.screen[1] - 60];
    await drag(page, top.screen, to, {
      beforeRelease: async () => {
        const held = await untilInspect(page, (state) => state.held === top.id && distance(point(state, top.id).screen, to) < 3);
        const { at } = point(held, top.id);
        assert.ok(outside(cube, at) > 0.05 * cube.balls[0].radius, "it was pulled out of where the surface was");
        assert.ok(outside(held, at) < 1e-4, "the surface has come along");
      },
    });
    const pulled = await atRest(page, ({ act }) => act === "Move");

    // A face is marked through the surface over it, selected by a click, and extruded by what is typed.
    const { face, middle } = await faceInSight(page, pulled, top.id);
    const over = await hover(page, middle, new RegExp(`^face ${face} of surface 1$`));
    assert.equal(over.marked.parts, 1);
    await page.mouse.click(...middle);
    const selected = await untilInspect(page, ({ selection }) => selection === over.hover);
    assert.equal(selected.document, pulled.document, "a click on a face changes nothing");
    await page.locator("#extrude-distance").fill("0.5");
    await page.locator("#extrude-distance").press("Enter");
    await page.locator("#extrude").click();
    const extruded = await atRest(page, ({ act }) => act === "Extrude");
    assert.equal(extruded.points.length, 12);
    assert.equal(extruded.selection, over.hover, "the face stays selected");
    const corners = (await documentOf(page)).cages[1].faces[face];
    assert.deepEqual([...corners].sort((a, b) => a - b), [9, 10, 11, 12]);

    // The face goes with the hand as a whole.
    const held = await placeOnFace(page, extruded, face, corners);
    await drag(page, held, [held[0] - 40, held[1] + 25]);
    const moved = await atRest(page, (state) => state.act === "Move" && state.document !== extruded.document);
    const ways = corners.map((id) => point(moved, id).at.map((x, k) => x - point(extruded, id).at[k]));
    assert.ok(Math.hypot(...ways[0]) > 0.05, "it moved");
    for (const way of ways) assert.ok(distance(way, ways[0]) < 1e-4, `all corners move alike: ${way} and ${ways[0]}`);
    assert.equal(moved.selection, over.hover);

    // E extrudes once more, and the buttons divide.
    await page.mouse.move(300, 500);
    await page.keyboard.press("e");
    await atRest(page, ({ act, points }) => act === "Extrude" && points.length === 16);
    await page.locator("#split-face").click();
    const split = await atRest(page, ({ act }) => act === "Split face");
    assert.equal(split.points.length, 17);
    await drawn(page);
    const edge = await edgeInSight(page, split);
    await page.mouse.click(...edge.place);
    await untilInspect(page, ({ selection }) => selection === edge.name);
    await page.locator("#split-edge").click();
    const last = await atRest(page, ({ act }) => act === "Split edge");
    assert.equal(last.points.length, 18);

    // The link holds it all; what was done can be taken back to nothing, and done again.
    await page.locator("#link").click();
    const told = await untilInspect(page, (state) => state.toast?.startsWith("Link copied"));
    assert.ok(told.toast.includes("18 points, 0 curves and 1 surface"), told.toast);
    const link = await page.evaluate(() => navigator.clipboard.readText());
    const friend = await session.visit(link, await session.browser.newContext({ viewport: wide }));
    const seen = await atRest(friend);
    assert.equal(seen.document, last.document);
    assert.deepEqual(seen.balls, last.balls, "the same surface");
    await friend.close();
    let acts = 0;
    for (let state = last; state.undo !== null && state.undo !== "New"; acts += 1) {
      const before = state.document;
      await page.keyboard.press("Control+z");
      state = await atRest(page, ({ document }) => document !== before);
    }
    assert.deepEqual(await documentOf(page), empty);
    for (let k = 0; k < acts; k += 1) {
      const { document } = await inspect(page);
      await page.keyboard.press("Control+Shift+z");
      await atRest(page, (state) => state.document !== document);
    }
    assert.equal((await inspect(page)).document, last.document);
    await page.reload();
    const reloaded = await atRest(page, ({ points }) => points.length === 18);
    assert.equal(reloaded.document, last.document);
    session.assertQuiet();
  } finally {
    await session.close();
  }
});

test("a face is split between two of its corners; what divides nothing is refused with its reason", async () => {
  await withPage({ viewport: wide }, async (page) => {
    await begun(page);
    const cube = await place(page, "Cube");
    const { faces } = JSON.parse(cube.document).cages[1];
    const first = inFront(cube);
    await page.keyboard.press("x");
    await untilInspect(page, ({ tool }) => tool === "divide");
    await hover(page, point(cube, first).screen, new RegExp(`^point ${first}$`));
    await page.mouse.click(...point(cube, first).screen);
    // From there a diagonal of each of the three faces could be taken.
    const begins = await untilInspect(page, ({ underWay, marked }) => underWay && marked.lines === 3);
    assert.equal(begins.document, cube.document);
    const face = faces.find((corners) => corners.includes(first));
    const at = face.indexOf(first);
    const [beside, across] = [1, 2].map((step) => face[(at + step) % 4]);

    // A neighbour is no choice: it is not marked, and a click says why.
    await page.mouse.move(...point(cube, beside).screen);
    await drawn(page);
    const over = await untilInspect(page, ({ hover }) => hover === null);
    assert.equal(over.marked.parts, 0);
    await page.mouse.click(...point(cube, beside).screen);
    const refused = await untilInspect(page, ({ toast }) => /An edge joins these corners already/.test(toast ?? ""));
    assert.deepEqual([refused.document, refused.underWay], [cube.document, true]);

    // Escape lets the corner go, and then goes back to the tool of cages.
    await page.keyboard.press("Escape");
    await untilInspect(page, ({ tool, underWay }) => tool === "divide" && !underWay);
    await page.keyboard.press("Escape");
    await untilInspect(page, ({ tool }) => tool === "cage");
    // The button begins at the selected vertex.
    await page.locator(`#scene-list [data-subject="point ${first}"]`).click();
    await page.locator("#divide").click();
    await untilInspect(page, ({ tool, underWay }) => tool === "divide" && underWay);
    const plain = await picture(page);
    await hover(page, point(cube, across).screen, new RegExp(`^point ${across}$`));
    await untilInspect(page, ({ marked }) => marked.parts === 1);
    assert.ok(difference(plain, await picture(page)) > 0.0005, "the new edge is shown");
    await page.mouse.click(...point(cube, across).screen);
    const split = await atRest(page, ({ act }) => act === "Split face");
    const now = JSON.parse(split.document).cages[1].faces;
    assert.equal(now.length, 7);
    assert.equal(now.filter((corners) => corners.length === 3 && corners.includes(first) && corners.includes(across)).length, 2);
    assert.equal(split.points.length, 8, "no vertex was made");
    assert.equal(split.tool, "divide", "the tool stays");
    await page.keyboard.press("Control+z");
    const back = await atRest(page, ({ act }) => act === "Undo Split face");
    assert.equal(back.document, cube.document);
  });
});

/** The vertex that is nearest to the eye. */
function inFront({ points, camera }) {
  return points.reduce((a, b) => (distance(b.at, camera.eye) < distance(a.at, camera.eye) ? b : a)).id;
}

/** A face of the cage at a vertex that can be pointed at in its middle. */
async function faceInSight(page, state, vertex) {
  const { faces } = JSON.parse(state.document).cages[1];
  for (const [face, corners] of faces.entries()) {
    if (!corners.includes(vertex)) continue;
    const middle = middleOf(state, corners);
    await page.mouse.move(...middle);
    await drawn(page);
    if ((await inspect(page)).hover === `face ${face} of surface 1`) return { face, middle };
  }
  return assert.fail("no face is in sight");
}

/** A place at which the surface over a face is in front: its middle may lie behind a wall of the face. */
async function placeOnFace(page, state, face, corners) {
  const middle = middleOf(state, corners);
  const toward = (id, part) => [0, 1].map((axis) => middle[axis] + part * (point(state, id).screen[axis] - middle[axis]));
  for (const place of [middle, ...corners.flatMap((id) => [0.3, 0.6].map((part) => toward(id, part)))]) {
    await page.mouse.move(...place);
    await drawn(page);
    if ((await inspect(page)).hover === `face ${face} of surface 1`) return place;
  }
  return assert.fail("the face is not in sight");
}

/** An edge of the cage whose middle can be pointed at. */
async function edgeInSight(page, state) {
  const { faces } = JSON.parse(state.document).cages[1];
  for (const face of faces) {
    for (let k = 0; k < face.length; k += 1) {
      const ends = [face[k], face[(k + 1) % face.length]].sort((a, b) => a - b);
      const [from, to] = ends.map((id) => point(state, id).screen);
      const place = [0, 1].map((axis) => (from[axis] + to[axis]) / 2);
      if (distance(from, to) < 50) continue;
      await page.mouse.move(...place);
      await drawn(page);
      const name = `edge ${ends.join("-")} of surface 1`;
      if ((await inspect(page)).hover === name) return { name, place };
    }
  }
  return assert.fail("no edge is in sight");
}

test("the settings of a surface over a cage are chosen in the properties, and bad ones are refused in words", async () => {
  await withPage({ viewport: wide }, async (page) => {
    await begun(page);
    await place(page, "Icosahedron");
    await page.locator('[data-command="select"][data-subject="surface 1"]').click();
    await page.locator("#cage-properties").waitFor({ state: "visible" });
    assert.equal(await page.locator("#mesh-properties").isVisible(), false, "an exact surface has no mesh of its own");
    await page.locator("#cage-split").selectOption({ label: "Catmull-Clark" });
    await atRest(page, ({ act }) => act === "Cage settings");
    await page.locator("#cage-blend").selectOption({ label: "Bump" });
    await untilInspect(page, ({ document }) => document.includes('"bump":1'));
    await page.locator("#cage-resolution").fill("6");
    await page.locator("#cage-resolution").press("Enter");
    const state = await atRest(page, ({ document }) => document.includes('"resolution":6'));
    const { settings } = (await documentOf(page)).cages[1];
    assert.deepEqual(settings, { split: "catmull-clark", blend: { bump: 1 }, resolution: 6 });
    await page.locator("#cage-split").selectOption({ label: "None" });
    await untilInspect(page, ({ toast }) => /every face needs 4/.test(toast ?? ""));
    assert.equal((await inspect(page)).document, state.document);
    await page.locator("#cage-resolution").fill("6.5");
    await page.locator("#cage-resolution").press("Enter");
    assert.match(await page.locator("#number-error").textContent(), /whole number/);
  });
});

test("a file of many triangles is imported as a mesh, and the other kind is one click away", async () => {
  await withPage({ viewport: wide }, async (page) => {
    await begun(page);
    const [around, across] = [24, 12];
    const angle = (k) => (2 * Math.PI * k) / around;
    const vertices = [];
    const faces = [];
    for (let i = 0; i < around; i += 1) {
      for (let j = 0; j < across; j += 1) {
        const [radius, height] = [1 + 0.4 * Math.cos((2 * Math.PI * j) / across), 0.4 * Math.sin((2 * Math.PI * j) / across)];
        vertices.push(`v ${radius * Math.cos(angle(i))} ${radius * Math.sin(angle(i))} ${height}`);
        const name = (a, b) => 1 + (a % around) * across + (b % across);
        faces.push(`f ${name(i, j)} ${name(i + 1, j)} ${name(i + 1, j + 1)}`, `f ${name(i, j)} ${name(i + 1, j + 1)} ${name(i, j + 1)}`);
      }
    }
    const buffer = Buffer.from([...vertices, ...faces].join("\n"));
    await page.locator("#file").setInputFiles({ name: "torus.obj", mimeType: "", buffer });
    const mesh = await atRest(page, ({ act }) => act === "Import");
    assert.equal(mesh.toast, "Imported as a mesh");
    assert.deepEqual(mesh.surfaces.map(({ kind, summary }) => [kind, summary.euler, summary.genus]), [["Mesh", 0, 1]]);
    assert.equal(mesh.points.length, 0);
    await page.locator("#toast-button").click();
    const cage = await atRest(page, ({ surfaces }) => surfaces.length === 1 && surfaces[0].kind === "Cage");
    assert.equal(cage.points.length, around * across);
    assert.equal(cage.toast, "Imported as a cage");
    await page.locator("#toast-button").click();
    const back = await atRest(page, ({ surfaces }) => surfaces.length === 1 && surfaces[0].kind === "Mesh");
    assert.equal(back.document, mesh.document);
    // Three pages on one spine are no surface of either kind: what was there stays.
    const book = Buffer.from("v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\nv 0 1 1\nf 1 2 3\nf 1 2 4\nf 1 2 5\n");
    await page.locator("#file").setInputFiles({ name: "book.obj", mimeType: "", buffer: book });
    await untilInspect(page, ({ toast }) => /^Import: /.test(toast ?? ""));
    assert.equal((await inspect(page)).document, back.document);
  });
});

test("OBJ and PLY files are imported as cages, and what is none is refused with its place", async () => {
  await withPage({ viewport: wide }, async (page) => {
    await begun(page);
    const file = (name, text) => ({ name, mimeType: "", buffer: Buffer.from(text) });
    const obj = "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0.5\nf 1 2 3 4\n";
    await page.locator("#file").setInputFiles(file("square.obj", obj));
    const one = await atRest(page, ({ act }) => act === "Import");
    assert.deepEqual(one.surfaces.map(({ kind }) => kind), ["Cage"]);
    const header = "ply\nformat binary_little_endian 1.0\nelement vertex 3\nproperty float x\nproperty float y\nproperty float z\n";
    const faces = "element face 1\nproperty list uchar int vertex_indices\nend_header\n";
    const numbers = Buffer.alloc(36 + 13);
    [2, 0, 0, 3, 0, 0, 2, 1, 0.5].forEach((x, k) => numbers.writeFloatLE(x, 4 * k));
    numbers.writeUInt8(3, 36);
    [0, 1, 2].forEach((corner, k) => numbers.writeInt32LE(corner, 37 + 4 * k));
    const ply = { name: "triangle.ply", mimeType: "", buffer: Buffer.concat([Buffer.from(header + faces), numbers]) };
    await page.locator("#file").setInputFiles(ply);
    const two = await atRest(page, ({ surfaces }) => surfaces.length === 2);
    assert.equal(two.points.length, 7);
    assert.equal(two.undo, "Import");
    await page.locator("#file").setInputFiles(file("bad.obj", "v 0 0 0\nv 1 one 0\n"));
    await untilInspect(page, ({ toast }) => /line 2: a coordinate/.test(toast ?? ""));
    assert.equal((await inspect(page)).document, two.document);
  });
});
