// The eye: mouse, keys, fingers, the size of the window. Whatever it does, the model stays and the picture shows it.

import assert from "node:assert/strict";
import { test } from "node:test";
import { assertOnCanvas, atRest, distance, drawn, newPoints, picture, point, wide } from "./support/model.mjs";
import { inspect, until, untilInspect, withPage } from "./support/page.mjs";
import { colours, pixels } from "./support/pixels.mjs";
import { drag, tap, touch } from "./support/pointer.mjs";

const empty = [90, 470];

test("right drag, left drag on nothing and Alt drag orbit; middle and Shift right drag pan; the wheel zooms", async () => {
  await withPage({ viewport: wide }, async (page) => {
    const start = await atRest(page);
    await assertOnCanvas(page, empty);
    const on = point(start, 7).screen;
    const aside = ([x, y], dx, dy) => [x + dx, y + dy];

    const orbits = [
      ["right drag on the model", on, { button: "right" }],
      ["left drag on nothing", empty, {}],
      ["Alt and left drag on the model", on, { modifiers: ["Alt"] }],
    ];
    let before = start.camera;
    for (const [what, from, how] of orbits) {
      await drag(page, from, aside(from, 70, -20), { steps: 10, ...how });
      const { camera } = await seen(page, start, what);
      assert.ok(distance(camera.forward, before.forward) > 0.1, `${what} turns the view`);
      assert.ok(Math.abs(camera.distance / before.distance - 1) < 0.2, `${what} comes no nearer`);
      assert.ok(Math.abs(camera.right[2]) < 1e-4, `${what} keeps the horizon level`);
      before = camera;
    }

    const pans = [
      ["middle drag", { button: "middle" }],
      ["Shift and right drag", { button: "right", modifiers: ["Shift"] }],
    ];
    for (const [what, how] of pans) {
      const from = point(await inspect(page), 7).screen;
      await drag(page, from, aside(from, 40, 20), { steps: 10, ...how });
      const state = await seen(page, start, what);
      assert.ok(distance(state.camera.forward, before.forward) < 1e-5, `${what} does not turn`);
      assert.ok(distance(point(state, 7).screen, aside(from, 40, 20)) < 3, `${what} takes the place along`);
      before = state.camera;
    }

    const held = point(await inspect(page), 7).screen;
    await page.mouse.move(...held);
    await page.mouse.wheel(0, -300);
    const near = await untilInspect(page, ({ camera }) => camera.distance < 0.9 * before.distance);
    assert.ok(distance(point(near, 7).screen, held) < 3, "the place under the pointer stays");
    await seen(page, start, "zooming in");
    await page.mouse.wheel(0, 600);
    await untilInspect(page, ({ camera }) => camera.distance > 1.1 * before.distance);
    await seen(page, start, "zooming out");
  });
});

test("keys bring the standard views, the projection and everything into view", async () => {
  await withPage({ viewport: wide }, async (page) => {
    const start = await atRest(page);
    const views = { 1: [0, 1, 0], 3: [-1, 0, 0], 7: [0, 0, -1], "Control+1": [0, -1, 0], "Shift+3": [1, 0, 0] };
    for (const [key, forward] of Object.entries(views)) {
      await page.keyboard.press(key);
      const looks = ({ camera }) => !camera.flying && distance(camera.forward, forward) < 0.01;
      await untilInspect(page, looks);
      await seen(page, start, `view ${key}`);
    }
    await page.keyboard.press("5");
    await untilInspect(page, ({ camera }) => camera.orthographic);
    await seen(page, start, "orthographic");
    await page.keyboard.press("5");
    await untilInspect(page, ({ camera }) => !camera.orthographic);

    await page.mouse.move(...empty);
    await page.mouse.wheel(0, 2000);
    const far = await untilInspect(page, ({ camera }) => camera.distance > 1.5 * start.camera.distance);
    await page.keyboard.press("Home");
    const fit = await untilInspect(page, ({ camera }) => !camera.flying && camera.distance < 0.9 * far.camera.distance);
    for (const { screen } of fit.points) assertInside(screen, wide);
    const spread = Math.max(...fit.points.map(({ screen }) => screen[0])) - Math.min(...fit.points.map(({ screen }) => screen[0]));
    assert.ok(spread > 0.3 * wide.width, `the model fills the window: ${spread}`);

    await page.keyboard.press("Shift+0");
    await page.keyboard.press("7");
    await untilInspect(page, ({ camera }) => !camera.flying && distance(camera.forward, [0, 0, -1]) < 0.01);
    await page.keyboard.press("0");
    await untilInspect(page, ({ camera }) => !camera.flying && distance(camera.forward, fit.camera.forward) < 0.01);
    await seen(page, start, "the stored view");
  });
});

test("a click on an axis turns to it", async () => {
  await withPage({ viewport: wide }, async (page) => {
    const start = await atRest(page);
    // The axes are small: look for one of them in their corner. Whichever it is, the view then looks along it.
    // Two clicks at one place would be a double click.
    const looksAlong = ({ camera }) => camera.forward.some((part) => Math.abs(Math.abs(part) - 1) < 0.01);
    let turned = null;
    for (let index = 0; index < 10 * 10 && !turned; index += 1) {
      await page.mouse.click(wide.width - 105 + 10 * (index % 10), wide.height - 140 + 10 * Math.floor(index / 10));
      const { flying } = (await inspect(page)).camera;
      if (flying) turned = await untilInspect(page, (state) => !state.camera.flying && looksAlong(state));
    }
    assert.ok(turned, "one of the axes was hit");
    assert.equal(turned.document, start.document);
  });
});

test("two fingers pan and zoom, one acts, two down and one up orbits, two taps undo", async () => {
  await withPage({ viewport: wide, context: { hasTouch: true } }, async (page) => {
    const start = await atRest(page);
    const path = (from, to, count = 10) =>
      Array.from({ length: count + 1 }, (_, i) => [0, 1].map((axis) => from[axis] + ((to[axis] - from[axis]) * i) / count));

    await touch(page, [path([350, 250], [390, 280]), path([450, 250], [490, 280])]);
    const panned = await seen(page, start, "two fingers");
    assert.ok(distance(panned.camera.target, start.camera.target) > 0.05, "two fingers pan");
    assert.ok(distance(panned.camera.forward, start.camera.forward) < 1e-5, "and do not turn");
    assert.ok(Math.abs(panned.camera.distance / start.camera.distance - 1) < 0.1, "nor zoom");

    await touch(page, [path([380, 280], [330, 280]), path([460, 280], [510, 280])]);
    const zoomed = await seen(page, start, "spreading fingers");
    assert.ok(zoomed.camera.distance < 0.75 * panned.camera.distance, "spreading comes nearer");

    await page.keyboard.press("Home");
    const home = await atRest(page, ({ camera }) => camera.distance > 1.1 * zoomed.camera.distance);
    const from = point(home, 7).screen;
    const to = [from[0], from[1] - 60];
    await touch(page, [path(from, to)]);
    const pulled = await atRest(page, (state) => state.document !== start.document);
    assert.deepEqual(newPoints(pulled, start), [], "the finger took the point that is there");
    assert.ok(distance(point(pulled, 7).screen, to) < 6, `one finger acts: ${point(pulled, 7).screen}`);
    assert.deepEqual(pulled.camera, home.camera, "and leaves the view alone");

    const back = await tapped(page, [[350, 250], [450, 260]], pulled.document);
    assert.equal(back.document, start.document, "a tap of two fingers takes it back");
    const again = await tapped(page, [[350, 250], [450, 260], [400, 300]], back.document);
    assert.equal(again.document, pulled.document, "a tap of three does it again");

    const client = await page.context().newCDPSession(page);
    const send = (type, touchPoints) => client.send("Input.dispatchTouchEvent", { type, touchPoints });
    const finger = (id, x, y) => ({ id, x, y });
    await send("touchStart", [finger(0, 350, 280), finger(1, 450, 280)]);
    await page.waitForTimeout(400);
    await send("touchEnd", [finger(1, 450, 280)]);
    for (let x = 350; x <= 430; x += 8) await send("touchMove", [finger(0, x, 280)]);
    await send("touchEnd", []);
    const turned = await untilInspect(page, ({ camera }) => distance(camera.forward, again.camera.forward) > 0.1);
    assert.equal(turned.document, again.document);
    await seen(page, again, "two down and one up");
  });
});

test("the picture follows the size of the window", async () => {
  await withPage({ viewport: wide }, async (page) => {
    const start = await atRest(page);
    // Nothing but the model: what the panels look like does not count.
    await page.keyboard.press("\\");
    for (const size of [{ width: 1000, height: 480 }, { width: 420, height: 620 }, { width: 700, height: 420 }]) {
      await page.setViewportSize(size);
      const fits = ([width, height]) => {
        const canvas = document.getElementById("view");
        return canvas.width === width && canvas.height === height;
      };
      await until(page, fits, [size.width, size.height]);
      await page.keyboard.press("Home");
      const state = await untilInspect(page, ({ camera, settled }) => settled && !camera.flying);
      for (const { screen } of state.points) assertInside(screen, size);
      await drawn(page);
      assert.ok(colours(await pixels(page, "canvas")) > 12, `${size.width} × ${size.height} shows the model`);
      assert.equal(state.document, start.document);
      // What is picked is what is shown.
      const at = point(state, 5).screen;
      await assertOnCanvas(page, at);
      await page.mouse.move(...at);
      await untilInspect(page, ({ hover }) => hover === "point 5");
    }
  });
});

test("a screen with two pixels to the point is drawn as fine as it is", async () => {
  await withPage({ viewport: { width: 500, height: 360 }, context: { deviceScaleFactor: 2 } }, async (page) => {
    const state = await atRest(page);
    const sizes = await page.evaluate(() => {
      const { width, height, clientWidth, clientHeight } = document.getElementById("view");
      return { width, height, clientWidth, clientHeight };
    });
    assert.deepEqual(sizes, { width: 1000, height: 720, clientWidth: 500, clientHeight: 360 });
    const at = point(state, 5).screen;
    await page.mouse.move(...at);
    await untilInspect(page, ({ hover }) => hover === "point 5");
  });
});

test("everything can be done with the keyboard", async () => {
  await withPage({ viewport: wide }, async (page) => {
    const start = await atRest(page);
    for (const [key, tool] of [["p", "point"], ["c", "curve"], ["s", "sheet"], ["w", "sweep"], ["v", "shape"]]) {
      await page.keyboard.press(key);
      await untilInspect(page, (state) => state.tool === tool);
      await page.locator(`#tool-${tool}[aria-pressed="true"]`).waitFor();
    }
    await page.keyboard.press("Tab");
    assert.equal(await page.evaluate(() => document.activeElement.id), "view", "the model is the first stop");
    for (const id of [1, 2, 3, 4, 5]) {
      await page.keyboard.press("Tab");
      await untilInspect(page, (state) => state.selection === `point ${id}`);
    }
    await page.keyboard.press("Shift+Tab");
    await untilInspect(page, (state) => state.selection === "point 4");
    await page.keyboard.press("Tab");
    await untilInspect(page, (state) => state.selection === "point 5");

    const before = point(start, 5);
    await page.keyboard.press("ArrowUp");
    const up = await atRest(page, (state) => state.document !== start.document);
    const step = before.screen[1] - point(up, 5).screen[1];
    assert.ok(step > 1, `up is up: ${step}`);
    await page.keyboard.press("Shift+ArrowRight");
    const right = await atRest(page, (state) => state.document !== up.document);
    assert.ok(point(right, 5).screen[0] - before.screen[0] > 3 * step, "with Shift it goes farther, to the right");
    await page.keyboard.press("Control+z");
    await page.keyboard.press("Control+z");
    assert.equal((await atRest(page, (state) => state.document !== right.document && state.undo === null)).document, start.document);

    await page.keyboard.press("Delete");
    const released = await atRest(page, (state) => state.document !== start.document);
    assert.ok(!JSON.parse(released.document).surfaces[1].skeleton.vertices.includes(5), "Delete releases a control");

    await page.keyboard.press("p");
    await page.keyboard.press("Space");
    const placed = await atRest(page, (state) => newPoints(state, released).length === 1);
    assert.equal(newPoints(placed, released)[0].role, "Free");
    await page.keyboard.press("Escape");
    await untilInspect(page, (state) => state.tool === "shape");

    await page.keyboard.press("Escape");
    await page.keyboard.press("Escape");
    assert.notEqual(await page.evaluate(() => document.activeElement.id), "view", "Escape gives the focus back");
    await page.keyboard.press("?");
    await page.locator("#keys").waitFor({ state: "visible" });
    await page.keyboard.press("Escape");
    await page.locator("#keys").waitFor({ state: "hidden" });
    await seen(page, placed, "the keyboard");
  });
});

/** Taps with fingers and waits for what comes of it. */
async function tapped(page, places, document) {
  await tap(page, ...places);
  return atRest(page, (state) => state.document !== document);
}

/** What every look at the model must satisfy: there is a picture, and the document is the same. */
async function seen(page, start, what) {
  await page.mouse.move(...empty);
  const state = await untilInspect(page, ({ camera, settled }) => settled && !camera.flying);
  assert.equal(state.document, start.document, `${what} leaves the document alone`);
  const count = colours(await picture(page));
  assert.ok(count > 12, `${what}: the picture has ${count} colours`);
  return state;
}

function assertInside([x, y], { width, height }) {
  assert.ok(x >= 0 && x <= width && y >= 0 && y <= height, `${x}, ${y} is within ${width} × ${height}`);
}
