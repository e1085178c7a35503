// The picture of the page in the README. `DUCTILE_PICTURES=1` takes it anew.

import assert from "node:assert/strict";
import { mkdir, readFile, writeFile } from "node:fs/promises";
import { test } from "node:test";
import { PNG } from "pngjs";
import { assertOnCanvas, atRest, distance, drawn, point } from "./support/model.mjs";
import { untilInspect, withPage } from "./support/page.mjs";
import { colours, difference, pixels } from "./support/pixels.mjs";
import { drag } from "./support/pointer.mjs";

const folder = new URL("../../docs/images/", import.meta.url);
const size = { width: 1280, height: 720 };

test("the page is worth a picture", async () => {
  await withPage({ viewport: size, context: { colorScheme: "light" } }, async (page) => {
    const before = await atRest(page);
    await drawn(page);
    const empty = await pixels(page);
    const from = point(before, 7).screen;
    const to = [from[0] + 30, from[1] - 110];
    await assertOnCanvas(page, from, to);
    await drag(page, from, to, { steps: 40 });
    const after = await atRest(page, (state) => state.document !== before.document);
    assert.ok(distance(point(after, 7).screen, to) < 3);
    // The toast goes by itself.
    await page.mouse.move(100, 500);
    await untilInspect(page, ({ toast, hover }) => toast === null && hover === null);
    await drawn(page);
    const seen = await pixels(page);
    assert.deepEqual({ width: seen.width, height: seen.height }, size);
    assert.ok(colours(seen) > 200, `shading gives many colours, not ${colours(seen)}`);
    assert.ok(difference(empty, seen) > 0.02, "the drag shows");
    if (process.env.DUCTILE_PICTURES === "1") {
      await mkdir(folder, { recursive: true });
      await writeFile(new URL("page.png", folder), PNG.sync.write(seen));
    }
  });
});

test("the README shows a picture of this page", async () => {
  const readme = await readFile(new URL("../../README.md", import.meta.url), "utf8");
  assert.match(readme, /!\[[^\]]+\]\(docs\/images\/page\.png\)/);
  const kept = PNG.sync.read(await readFile(new URL("page.png", folder)));
  assert.deepEqual({ width: kept.width, height: kept.height }, size);
  assert.ok(colours(kept) > 200);
});
