// A browser without WebGPU: no picture, and everything else.

import assert from "node:assert/strict";
import { readFile } from "node:fs/promises";
import { test } from "node:test";
import { atRest, choose, wide } from "./support/model.mjs";
import { untilInspect, withPage } from "./support/page.mjs";

const browsers = {
  "no graphics adapter": { webgpu: false, allow: /^console warning: No available adapters\.$/ },
  "no WebGPU at all": { init: () => Object.defineProperty(Navigator.prototype, "gpu", { get: () => undefined }) },
};

for (const [what, options] of Object.entries(browsers)) {
  test(`with ${what} the page says which browsers have it; the model opens, saves and exports`, async () => {
    await withPage({ viewport: wide, ...options }, async (page) => {
      const state = await atRest(page, ({ gpu }) => gpu !== "starting");
      assert.equal(state.gpu, "missing");
      assert.equal(state.pictures, 0);
      assert.equal(state.banners.length, 1);
      for (const name of ["WebGPU", "Chrome", "Edge", "Safari", "Firefox"]) {
        assert.ok(state.banners[0].includes(name), `the banner names ${name}`);
      }
      assert.equal(await page.locator("#banners .banner").isVisible(), true);
      assert.equal(state.surfaces.length, 1, "the model is there");
      assert.ok(state.figures.energy > 1, "and relaxed");

      const saving = page.waitForEvent("download", { timeout: 60_000 });
      await page.locator('#banners [data-command="save"]').click();
      const text = await readFile(await (await saving).path(), "utf8");
      assert.deepEqual(JSON.parse(text), JSON.parse(state.document));

      const exporting = page.waitForEvent("download", { timeout: 60_000 });
      await page.locator('#banners [data-command="export-obj"]').click();
      const obj = await readFile(await (await exporting).path(), "utf8");
      assert.equal(obj.split("\n").filter((line) => line.startsWith("v ")).length, state.surfaces[0].vertex_count);

      // The banner must not stand before the menus.
      await choose(page, "file", "new");
      await atRest(page, ({ points }) => points.length === 0);
      const renamed = { ...JSON.parse(text), name: "By file" };
      const buffer = Buffer.from(JSON.stringify(renamed));
      await page.locator("#file").setInputFiles({ name: "a.json", mimeType: "application/json", buffer });
      const opened = await atRest(page, ({ name }) => name === "By file");
      assert.equal(opened.surfaces.length, 1);
      await page.keyboard.press("Control+z");
      await untilInspect(page, ({ name }) => name !== "By file");
    });
  });
}
