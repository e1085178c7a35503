// What shapes minimise is chosen in the properties, for the document, a curve, a surface or a region of it.

import assert from "node:assert/strict";
import { test } from "node:test";
import { mkdtemp, writeFile } from "node:fs/promises";
import { tmpdir } from "node:os";
import { join } from "node:path";
import { atRest, documentOf, drawn, picture, point, pulled, wide } from "./support/model.mjs";
import { until, untilInspect, withPage } from "./support/page.mjs";

/** A tube on three circles, so that the middle one cuts it in two regions. */
function tube() {
  const points = {};
  const curves = {};
  const triangles = [];
  const embeddings = [];
  for (let level = 0; level < 3; level++) {
    const ids = [];
    for (let k = 0; k < 4; k++) {
      const id = 4 * level + k + 1;
      points[id] = [[1, 0], [0, 1], [-1, 0], [0, -1]][k].concat(level - 1);
      ids.push(id);
      if (level > 0) {
        const [a, b] = [4 * (level - 1) + k, 4 * (level - 1) + ((k + 1) % 4)];
        triangles.push([a, b, a + 4], [b, b + 4, a + 4]);
      }
    }
    curves[level + 1] = { through: ids, closed: true };
    embeddings.push({ curve: level + 1, along: ids.map((id) => id - 1) });
  }
  const vertices = Object.keys(points).map(Number);
  return { ductile: 1, points, curves, surfaces: { 1: { skeleton: { vertices, triangles, curves: embeddings } } } };
}

async function openFile(page, document) {
  const file = join(await mkdtemp(join(tmpdir(), "ductile-")), "tube.ductile.json");
  await writeFile(file, JSON.stringify(document));
  await page.locator("#file").setInputFiles(file);
  return atRest(page, (state) => state.points.length === Object.keys(document.points).length);
}

/** Waits until a select shows a choice: its place in the menu, or "" for none of its own. */
function shows(page, id, value) {
  return until(page, ([id, value]) => document.getElementById(id).checkVisibility() && document.getElementById(id).value === value, [id, value], { timeout: 5000 });
}

/** A place on the near side of the tube, a quarter of its height from the middle circle. */
function between(state, [a, b]) {
  const places = [a, b].map((id) => point(state, id).screen);
  return [0, 1].map((axis) => 0.5 * (places[0][axis] + places[1][axis]));
}

test("the document's objective changes the shape, is undone, and travels with the document", async () => {
  await withPage({ viewport: wide }, async (page) => {
    const before = await pulled(page);
    const seen = await picture(page);
    await page.locator("#view").focus();
    await page.keyboard.press("Escape");
    await shows(page, "objective", "0");
    await page.locator("#objective").selectOption({ label: "Fair" });
    const fair = await atRest(page, (state) => state.document !== before.document);
    assert.equal((await documentOf(page)).objective, "fair");
    assert.equal(fair.act, "Objective");
    assert.ok(fair.figures.energy < 0.5 * before.figures.energy, "variation is what is counted now");
    await drawn(page);
    assert.notDeepEqual(await picture(page), seen, "the picture is another");
    await page.locator("#view").focus();
    await page.keyboard.press("Control+z");
    const after = await atRest(page, (state) => state.document === before.document);
    assert.ok(Math.abs(after.figures.energy / before.figures.energy - 1) < 0.01);
    await shows(page, "objective", "0");
  });
});

test("a region of a surface draws in like a film while the other stays", async () => {
  await withPage({ viewport: wide }, async (page) => {
    const whole = await openFile(page, tube());
    // Points of the upper and the middle circle that look at the camera.
    const near = [1, 2, 3, 4].map((k) => [k, whole.points.find(({ id }) => id === k).screen[1]]).sort((a, b) => b[1] - a[1])[0][0];
    const at = between(whole, [near + 4, near + 8]);
    await page.mouse.click(...at);
    await untilInspect(page, ({ selection }) => selection === "surface 1");
    await shows(page, "region-objective", "");
    await page.locator("#region-objective").selectOption({ label: "Membrane" });
    const film = await atRest(page, (state) => state.document !== whole.document);
    const { regions } = (await documentOf(page)).surfaces[1];
    assert.deepEqual(regions.map(({ objective }) => objective), ["membrane"]);
    assert.equal(film.banners.length, 0);
    // The choice is shown again when the region is clicked, and not for the other one.
    await page.mouse.click(...between(film, [near, near + 4]));
    await untilInspect(page, ({ selection }) => selection === "surface 1");
    await shows(page, "region-objective", "");
    await page.mouse.click(...at);
    await shows(page, "region-objective", "3");
  });
});

test("a curve and a surface follow the document until they choose", async () => {
  await withPage({ viewport: wide }, async (page) => {
    const before = await atRest(page);
    await page.locator('#scene-list [data-subject="curve 1"]').click();
    await shows(page, "objective", "");
    assert.equal(await page.locator("#objective option").first().textContent(), "As the document");
    await page.locator("#objective").selectOption({ label: "Neutral" });
    await atRest(page, (state) => state.document !== before.document);
    assert.equal((await documentOf(page)).curves[1].objective, "neutral");
    await page.locator("#objective").selectOption({ index: 0 });
    await atRest(page, (state) => state.document === before.document);
    await page.locator('#scene-list [data-subject="surface 1"]').click();
    await page.locator("#objective").selectOption({ label: "Membrane" });
    await atRest(page, (state) => state.document !== before.document);
    assert.equal((await documentOf(page)).surfaces[1].objective, "membrane");
    assert.equal(await page.locator("#region-objective").isVisible(), false, "a surface in one piece has no regions");
  });
});
