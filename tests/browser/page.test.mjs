// The page opens and shows something.

import assert from "node:assert/strict";
import { test } from "node:test";
import { withPage } from "./support/page.mjs";
import { colours, pixels } from "./support/pixels.mjs";

test("the page opens without a complaint and draws a shaded surface", async () => {
  await withPage({}, async (page, { server }) => {
    await page.waitForTimeout(1000);
    const seen = colours(await pixels(page, "canvas"));
    assert.ok(seen > 20, `shading gives many colours, not ${seen}`);
    assert.ok(server.requests.some((path) => path.endsWith(".wasm")));
  });
});
