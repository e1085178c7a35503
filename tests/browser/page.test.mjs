// The page opens and shows something.

import assert from "node:assert/strict";
import { test } from "node:test";
import { atRest, distance, drawn } from "./support/model.mjs";
import { drag } from "./support/pointer.mjs";
import { untilInspect, withPage } from "./support/page.mjs";
import { colours, pixels } from "./support/pixels.mjs";

test("the page opens without a complaint and draws a shaded surface", async () => {
  await withPage({}, async (page, { server }) => {
    await atRest(page);
    await drawn(page);
    const seen = colours(await pixels(page, "canvas"));
    assert.ok(seen > 20, `shading gives many colours, not ${seen}`);
    assert.ok(server.requests.some((path) => path.endsWith(".wasm")));
  });
});

// Desktop, small desktop, phone, and as low as it gets.
for (const [width, height] of [[1280, 720], [800, 600], [390, 844], [640, 400]]) {
  test(`the welcome stands beside the model at ${width} × ${height}, until the first drag`, async () => {
    await withPage({ viewport: { width, height } }, async (page) => {
      const state = await atRest(page, ({ pictures }) => pictures > 0);
      const welcome = page.locator("#welcome");
      await welcome.waitFor({ state: "visible" });
      const box = await welcome.boundingBox();
      assert.ok(box.x >= 0 && box.x + box.width <= width, "it is within the window");
      const places = [...state.points.map(({ screen }) => screen), ...state.curves[0].screen];
      // The shape rises a little over its points: as far as a tenth of their extent, and room for a point's own size.
      const [top, bottom] = [Math.min, Math.max].map((most) => most(...places.map(([, y]) => y)));
      const room = 8 + 0.1 * (bottom - top);
      const clear = box.y + box.height + room <= top || box.y >= bottom + room;
      assert.ok(clear, `the text from ${box.y} to ${box.y + box.height}, the model from ${top} to ${bottom}`);
      for (const selector of ["#side", "#bar .cluster", "#tools", "#hint"]) {
        for (const other of await page.locator(selector).all()) {
          const chrome = await other.boundingBox();
          if (chrome) assert.ok(apart(box, chrome), `${selector} is beside it`);
        }
      }
      const from = state.points.find(({ id }) => id === 7).screen;
      await drag(page, from, [from[0], from[1] - 20]);
      await welcome.waitFor({ state: "hidden" });
      await untilInspect(page, ({ points }) => distance(points.find(({ id }) => id === 7).screen, from) > 10);
    });
  });
}

function apart(one, other) {
  const beside = one.x + one.width <= other.x || other.x + other.width <= one.x;
  return beside || one.y + one.height <= other.y || other.y + other.height <= one.y;
}
