// The rim of an open cage as a control curve: made by a button, led by the cage, skinned like any curve, taken back.

import assert from "node:assert/strict";
import { test } from "node:test";
import { atRest, choose, distance, point, wide } from "./support/model.mjs";
import { inspect, untilInspect, withPage } from "./support/page.mjs";
import { drag } from "./support/pointer.mjs";

const middle = (places) => [0, 1].map((axis) => places.reduce((sum, place) => sum + place[axis] / places.length, 0));

/** How far a place is from the nearest sample of a curve that the page tells of. */
const apart = (curve, at) => Math.min(...curve.at.map((sample) => distance(sample, at)));

test("the rim of a cage leads a control curve, and a sheet over it follows", async () => {
  await withPage({ viewport: wide }, async (page) => {
    await atRest(page);
    await choose(page, "file", "new");
    await atRest(page, ({ points }) => points.length === 0);
    await page.keyboard.press("q");
    await page.locator("#cage-form").selectOption({ label: "Cube" });
    await page.mouse.click(400, 290);
    const cube = await atRest(page, ({ act }) => act === "Cage");
    const screens = (ids) => ids.map((id) => point(cube, id).screen);
    const height = (corners) => corners.reduce((sum, id) => sum + point(cube, id).at[2], 0);
    const { faces } = JSON.parse(cube.document).cages[1];
    const top = faces.reduce((a, b) => (height(b) > height(a) ? b : a));

    await page.mouse.click(...middle(screens(top)));
    await untilInspect(page, ({ selection }) => /^face \d+ of surface 1$/.test(selection ?? ""));
    await page.keyboard.press("Delete");
    const open = await atRest(page, ({ act }) => act === "Delete face");
    const ends = top.slice(0, 2);
    const name = `edge ${[...ends].sort((a, b) => a - b).join("-")} of surface 1`;
    await page.mouse.click(...middle(screens(ends)));
    await untilInspect(page, ({ selection }) => selection === name);
    await page.locator("#rim-curve").click();
    const ruled = await atRest(page, ({ act }) => act === "Rim curve");
    assert.deepEqual(ruled.curves.map(({ closed }) => closed), [true]);
    assert.equal(JSON.parse(ruled.document).curves[1].rim, 1);
    assert.equal(ruled.points.length, 8, "its points are vertices of the cage");

    // A sheet over it is a fair surface with that rim.
    await page.locator("#tool-sheet").click();
    await page.mouse.click(...ruled.curves[0].screen[1]);
    const lid = await atRest(page, ({ act, surfaces }) => act === "Sheet" && surfaces.length === 2);
    assert.deepEqual(lid.surfaces.map(({ kind }) => kind).sort(), ["Cage", "Fair"]);

    // A vertex of the rim is dragged: curve and cage go with it before the hand lets go.
    await page.keyboard.press("v");
    await untilInspect(page, ({ tool }) => tool === "shape");
    const corner = top.map((id) => point(lid, id)).reduce((a, b) => (distance(b.at, lid.camera.eye) < distance(a.at, lid.camera.eye) ? b : a));
    const to = [corner.screen[0] + 25, corner.screen[1] + 30];
    await drag(page, corner.screen, to, {
      beforeRelease: async () => {
        const held = await untilInspect(page, (state) => state.held === corner.id && distance(point(state, corner.id).screen, to) < 3);
        assert.ok(apart(held.curves[0], point(held, corner.id).at) < 1e-5, "the curve has come along");
      },
    });
    const moved = await atRest(page, ({ act }) => act === "Move");
    assert.ok(distance(point(moved, corner.id).at, corner.at) > 0.05);
    assert.ok(apart(moved.curves[0], point(moved, corner.id).at) < 1e-5);

    for (let state = moved; state.document !== open.document; ) {
      const { document } = state;
      assert.notEqual(state.undo, "Delete face", "it is all taken back");
      await page.keyboard.press("Control+z");
      state = await atRest(page, (now) => now.document !== document);
    }
    assert.equal((await inspect(page)).curves.length, 0);
  });
});

test("a part of a rim becomes a curve between two vertices that are clicked", async () => {
  await withPage({ viewport: wide }, async (page) => {
    await atRest(page);
    await choose(page, "file", "new");
    await atRest(page, ({ points }) => points.length === 0);
    await page.keyboard.press("q");
    await page.locator("#cage-form").selectOption({ label: "Grid" });
    await page.mouse.click(400, 290);
    const grid = await atRest(page, ({ act }) => act === "Cage");
    // A row of five vertices at an edge of the grid, in order: those with the least x.
    const least = Math.min(...grid.points.map(({ at }) => at[0]));
    const row = grid.points.filter(({ at }) => at[0] < least + 1e-4).sort((a, b) => a.at[1] - b.at[1]);
    assert.equal(row.length, 5);
    await page.mouse.click(...middle([row[1].screen, row[2].screen]));
    await untilInspect(page, ({ selection }) => /^edge \d+-\d+ of surface 1$/.test(selection ?? ""));
    await page.locator("#rim-between").click();
    await untilInspect(page, ({ tool, marked }) => tool === "divide" && marked.parts >= 1);

    // A vertex inside is no choice; one of the rim is, and from there on a line shows what would become a curve.
    const inside = grid.points.find(({ at }) => Math.hypot(at[0] - row[2].at[0], at[1] - row[2].at[1]) > 0.1 && Math.abs(at[1] - row[2].at[1]) < 1e-4);
    await page.mouse.move(...inside.screen);
    await untilInspect(page, ({ hover }) => hover === null);
    await page.mouse.move(...row[0].screen);
    await untilInspect(page, ({ hover }) => hover === `point ${row[0].id}`);
    await page.mouse.click(...row[0].screen);
    await untilInspect(page, ({ underWay }) => underWay);
    await page.mouse.move(...row[3].screen);
    await untilInspect(page, ({ hover, marked }) => hover === `point ${row[3].id}` && marked.lines === 1);
    // The edge that was chosen has to lie between.
    await page.mouse.click(...row[1].screen);
    const refused = await untilInspect(page, ({ toast }) => /does not lie between/.test(toast ?? ""));
    assert.equal(refused.document, grid.document);
    await page.keyboard.press("Escape");
    await untilInspect(page, ({ tool, underWay }) => tool === "divide" && !underWay);
    for (const { screen } of [row[0], row[3]]) await page.mouse.click(...screen);
    const ruled = await atRest(page, ({ act }) => act === "Rim curve");
    const { through, closed, rim } = JSON.parse(ruled.document).curves[1];
    const wanted = row.slice(0, 4).map(({ id }) => id);
    assert.ok([wanted, [...wanted].reverse()].some((way) => way.join() === through.join()), `${through}`);
    assert.ok(!closed && rim === 1);
    await untilInspect(page, ({ tool }) => tool === "shape");
    await page.keyboard.press("Control+z");
    await atRest(page, ({ document }) => document === grid.document);
  });
});
