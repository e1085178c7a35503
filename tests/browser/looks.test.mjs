// Looks: what surfaces show instead of light, and the legend that says what it means and can be changed.

import assert from "node:assert/strict";
import { test } from "node:test";
import { assertOnCanvas, atRest, choose, drawn, onBareSurface, picture, wide } from "./support/model.mjs";
import { until, untilInspect, withPage } from "./support/page.mjs";
import { at, difference, pixels } from "./support/pixels.mjs";
import { drag } from "./support/pointer.mjs";

/** Opens an example by its menu, and hides the control skeleton: only surfaces are looked at. */
async function example(page, word) {
  await atRest(page);
  await page.locator("#file-button").click();
  await page.locator(`#examples [data-subject="${word}"]`).click();
  await atRest(page, ({ openings }) => openings === 2);
  await choose(page, "look", "look-skeleton");
  await page.keyboard.press("Escape");
}

/** Types into a field of the legend. */
async function type(page, id, text) {
  await page.locator(`#${id}`).fill(text);
  await page.locator(`#${id}`).press("Enter");
  await until(page, ([id, text]) => document.getElementById(id).value === text, [id, text]);
}

/** Mean red, green and blue of a patch of the picture. */
function patch(seen, [x, y], radius = 6) {
  const sum = [0, 0, 0];
  for (let dy = -radius; dy <= radius; dy += 1) {
    for (let dx = -radius; dx <= radius; dx += 1) at(seen, x + dx, y + dy).forEach((value, k) => (sum[k] += value));
  }
  return sum.map((value) => value / (2 * radius + 1) ** 2);
}

/** The middle of the canvas between the panels, where an example that fills the view has its middle. */
function middleOf(page) {
  return page.evaluate(() => {
    const place = (id) => document.getElementById(id).getBoundingClientRect();
    // Of the lower edge, 60 px are for the status line and the hint.
    return [(place("tools").right + place("side").left) / 2, (place("bar").bottom + innerHeight - 60) / 2];
  });
}

test("mean curvature: a ball has one colour, that of its value in the legend, and the other end's when turned inside out", async () => {
  await withPage({ viewport: wide }, async (page) => {
    await example(page, "ball");
    await page.keyboard.press("Alt+7");
    await untilInspect(page, ({ shading }) => shading === "mean");
    const middle = await middleOf(page);
    await assertOnCanvas(page, middle);
    const fitted = await page.evaluate(() => ["legend-low", "legend-high"].map((id) => Number(document.getElementById(id).value)));
    assert.ok(fitted[0] < -0.95 && fitted[0] > -1.1 && fitted[1] > -1.05 && fitted[1] < -0.9, `a ball of radius 1: ${fitted}`);

    // The ball, at -1, lies on the first colour.
    await type(page, "legend-high", "1");
    await type(page, "legend-low", "-1");
    await drawn(page);
    const blue = patch(await pixels(page), middle);
    assert.ok(blue[2] > 1.8 * blue[0] && blue[2] > 1.3 * blue[1], `blue, not ${blue}`);
    // In the middle of the range it is grey.
    await type(page, "legend-low", "-3");
    await drawn(page);
    const grey = patch(await pixels(page), middle);
    assert.ok(Math.max(...grey) - Math.min(...grey) < 14 && grey[0] > 150, `grey, not ${grey}`);

    // Turned inside out it bends toward its normals: +1, the last colour.
    await page.mouse.click(...middle);
    await page.locator("#reverse").click();
    await atRest(page, ({ act }) => act === "Reverse");
    await type(page, "legend-low", "-1");
    // What is selected or pointed at is tinted.
    await page.locator("#view").focus();
    await page.keyboard.press("Escape");
    await page.mouse.move(80, 300);
    await untilInspect(page, ({ hover }) => hover === null);
    await drawn(page);
    const orange = patch(await pixels(page), middle);
    assert.ok(orange[0] > 1.8 * orange[2], `orange, not ${orange}`);

    await page.locator("#legend-low").fill("2");
    await page.locator("#legend-low").press("Enter");
    await until(page, () => /below the upper/.test(document.getElementById("number-error").textContent));
    await page.locator("#legend-low").press("Escape");
    await page.locator("#legend-fit").click();
    await until(page, () => Math.abs(Number(document.getElementById("legend-low").value) - 1) < 0.06);
  });
});

test("the handles of the ramp move its ends and push one another", async () => {
  await withPage({ viewport: wide }, async (page) => {
    await example(page, "torus");
    await choose(page, "look", "look-mean");
    await page.keyboard.press("Escape");
    const ends = () => page.evaluate(() => ["legend-low", "legend-high"].map((id) => Number(document.getElementById(id).value)));
    const fitted = await ends();
    const before = await picture(page);
    const ramp = await page.locator("#ramp").boundingBox();
    const y = ramp.y + ramp.height / 2;
    const handle = ramp.x + 0.2 * ramp.width;
    await drag(page, [handle, y], [handle + 0.35 * ramp.width, y], { steps: 10 });
    const slid = await ends();
    assert.ok(slid[0] > fitted[0] && Math.abs(slid[1] - fitted[1]) < 1e-9, `${fitted} became ${slid}`);
    assert.ok(difference(before, await picture(page)) > 0.05, "the colours follow");
    // Beyond the other end: both go.
    await page.locator("#range-low").focus();
    await page.keyboard.press("End");
    const pushed = await ends();
    assert.ok(pushed[0] > fitted[1] && pushed[1] >= pushed[0], `${slid} became ${pushed}`);
  });
});

test("isophotes are dark and light bands, as many as chosen, and move with a drag", async () => {
  await withPage({ viewport: wide }, async (page) => {
    const start = await atRest(page);
    await choose(page, "look", "look-skeleton");
    await page.keyboard.press("Escape");
    const shaded = await picture(page);
    await page.keyboard.press("Alt+4");
    await untilInspect(page, ({ shading }) => shading === "isophotes");
    const seen = await picture(page);
    assert.ok(difference(shaded, seen) > 0.2, "the surface looks otherwise");
    assert.ok(edges(seen) > 1.5 * edges(shaded), "there are bands");
    await page.locator("#bands").focus();
    await page.keyboard.press("End");
    const fine = await picture(page);
    assert.ok(edges(fine) > 1.5 * edges(seen), `more bands: ${edges(seen)} and ${edges(fine)}`);
    await page.keyboard.press("Home");
    const coarse = await picture(page);
    assert.ok(edges(coarse) < edges(seen), "fewer bands");
    const [from, to] = onBareSurface(start);
    await drag(page, from, to, { steps: 12 });
    await atRest(page, ({ document }) => document !== start.document);
    assert.ok(difference(coarse, await picture(page)) > 0.02, "they moved with the surface");
  });
});

test("contours lie at even heights, along the axis and at the distance of the legend; the look is kept for the next visit", async () => {
  await withPage({ viewport: wide }, async (page) => {
    await example(page, "ball");
    await page.keyboard.press("1");
    await untilInspect(page, ({ camera }) => !camera.flying && camera.forward[1] > 0.99);
    await page.keyboard.press("Alt+6");
    await until(page, () => document.getElementById("slice-distance").value === "0.07");
    const { camera } = await untilInspect(page, ({ shading }) => shading === "contours");
    const column = Math.round((await middleOf(page))[0]) + 5;
    const lines = async () => crossings(await pixels(page), column);
    await type(page, "slice-distance", "0.1");
    await drawn(page);
    const tenths = await lines();
    assert.ok(tenths >= 16 && tenths <= 21, `a ball of radius 1 has 19 or so lines a tenth apart, not ${tenths}`);
    await type(page, "slice-distance", "0.25");
    await drawn(page);
    const quarters = await lines();
    assert.ok(quarters >= 6 && quarters <= 8, `7 or so a quarter apart, not ${quarters}`);
    await page.locator("#slices").selectOption({ label: "X" });
    await drawn(page);
    assert.ok((await lines()) <= 1, "across x they run upright");
    assert.ok(camera.distance > 0);

    await page.reload();
    await atRest(page);
    await untilInspect(page, ({ shading }) => shading === "contours");
    await until(page, () => !document.getElementById("legend").hidden);
    await page.keyboard.press("Alt+1");
    await until(page, () => document.getElementById("legend").hidden);
  });
});

/** How often neighbours in a row differ much: what bands and lines make. */
function edges(seen) {
  let count = 0;
  for (let y = 0; y < seen.height; y += 3) {
    for (let x = 1; x < seen.width; x += 1) {
      count += Math.abs(at(seen, x, y)[1] - at(seen, x - 1, y)[1]) > 40 ? 1 : 0;
    }
  }
  return count;
}

/** How many thin dark lines a column of the picture crosses on the ball in its middle: dark between two like places, which the ball's own outline is not. */
function crossings(seen, x) {
  let count = 0;
  let was = false;
  for (let y = 60; y < seen.height - 60; y += 1) {
    const around = [at(seen, x, y - 4)[1], at(seen, x, y + 4)[1]];
    const dark = at(seen, x, y)[1] < Math.min(...around) - 25;
    count += dark && !was ? 1 : 0;
    was = dark;
  }
  return count;
}
