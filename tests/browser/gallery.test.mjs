// The pictures of docs/gallery.md: each scene opens, rests and draws what it is called. `GALLERY=1` takes the pictures anew.

import assert from "node:assert/strict";
import { mkdir, readFile, writeFile } from "node:fs/promises";
import { test } from "node:test";
import { PNG } from "pngjs";
import { atRest, choose, drawn } from "./support/model.mjs";
import { untilInspect, withPage } from "./support/page.mjs";
import { colours, difference, pixels } from "./support/pixels.mjs";

const folder = new URL("../../docs/images/gallery/", import.meta.url);
const size = { width: 600, height: 450 };
/** Where the surface is, without the chrome around it. */
const clip = { left: 90, top: 45, width: 420, height: 360 };
/** Bytes that a picture may have. */
const most = 80_000;

const looks = { shaded: "Alt+1", isophotes: "Alt+4", contours: "Alt+6", mean: "Alt+7" };

/** The scenes with the looks in which they are shown. */
const scenes = [
  ["torus", ["shaded"]],
  ["klein-mug", ["shaded"]],
  ["party-hat", ["shaded"]],
  ["moebius-strip", ["shaded"]],
  ["five-sided", ["shaded", "isophotes", "contours"]],
  ["connected-patches", ["shaded", "isophotes", "contours"]],
  ["torus-cage", ["isophotes", "mean"]],
  ["trebol", ["isophotes", "mean"]],
  ["icosahedron", ["isophotes", "mean"]],
];

/** Opens a document of tests/gallery, which the script of its name gave, or an example: by the menu, or as a file, changed. */
async function example(page, word, change) {
  const { openings } = await atRest(page);
  const folder = change ? "../../crates/modeler/src/example" : "../gallery";
  const file = new URL(`${folder}/${word}.ductile.json`, import.meta.url);
  const text = await readFile(file, "utf8").catch(() => null);
  if (text === null) {
    await page.locator("#file-button").click();
    await page.locator(`#examples [data-subject="${word}"]`).click();
  } else {
    const buffer = Buffer.from(JSON.stringify(change ? change(JSON.parse(text)) : JSON.parse(text)));
    await page.locator("#file").setInputFiles({ name: `${word}.ductile.json`, mimeType: "", buffer });
  }
  await atRest(page, (state) => state.openings === openings + 1 && state.surfaces.length > 0);
}

/** Hides what is no surface: panels and the control skeleton. */
async function bare(page) {
  await choose(page, "look", "look-skeleton");
  await page.keyboard.press("Escape");
  await page.locator("#view").focus();
  await page.keyboard.press("h");
  // A little farther off, so that nothing is cut.
  await page.mouse.move(size.width / 2, size.height / 2);
  await page.mouse.wheel(0, 240);
}

/** Shows a look, and takes its picture if pictures are wanted. */
async function take(page, name, look) {
  await page.keyboard.press(looks[look]);
  await untilInspect(page, ({ shading }) => shading === look);
  await page.mouse.move(30, 240);
  await untilInspect(page, ({ toast, hover }) => toast === null && hover === null);
  await drawn(page);
  const whole = await pixels(page);
  const part = new PNG({ width: clip.width, height: clip.height });
  PNG.bitblt(whole, part, clip.left, clip.top, clip.width, clip.height, 0, 0);
  assert.ok(colours(part) > 24, `${name} in ${look} has ${colours(part)} colours`);
  // What dithering adds takes half of the bytes.
  const step = look === "mean" ? 8 : 4;
  for (let i = 0; i < part.data.length; i += 1) part.data[i] = part.data[i] - (part.data[i] % step) + step / 2;
  const bytes = PNG.sync.write(part, { deflateLevel: 9, colorType: 2 });
  assert.ok(bytes.length < most, `${name} in ${look} has ${bytes.length} bytes`);
  if (process.env.GALLERY === "1") {
    await mkdir(folder, { recursive: true });
    await writeFile(new URL(`${name}-${look}.png`, folder), bytes);
  }
  return part;
}

const options = { viewport: size, context: { colorScheme: "light" } };

for (const [word, shown] of scenes) {
  test(`the gallery shows ${word} in ${shown.join(", ")}`, async () => {
    await withPage(options, async (page) => {
      await example(page, word);
      await bare(page);
      for (const look of shown) await take(page, word, look);
    });
  });
}

test("the gallery shows what a displacement cures in a patch of six sides", async () => {
  await withPage(options, async (page) => {
    await example(page, "six-sided", ({ displacements, ...filled }) => filled);
    await bare(page);
    const before = await take(page, "six-sided-before", "shaded");
    await take(page, "six-sided-before", "contours");
    // Not by the menu: panels are hidden now.
    await example(page, "six-sided", (document) => document);
    await page.mouse.wheel(0, 240);
    const after = await take(page, "six-sided", "shaded");
    await take(page, "six-sided", "contours");
    assert.ok(difference(before, after) > 0.02, "the displacement shows");
  });
});

test("the gallery has every picture that it shows, and shows every picture that it has", async () => {
  const text = await readFile(new URL("../../docs/gallery.md", import.meta.url), "utf8");
  const shown = [...text.matchAll(/\]\(images\/gallery\/([a-z-]+)\.png\)/g)].map(([, name]) => name).sort();
  const taken = scenes.flatMap(([word, list]) => list.map((look) => `${word}-${look}`));
  for (const word of ["six-sided", "six-sided-before"]) taken.push(`${word}-shaded`, `${word}-contours`);
  assert.deepEqual(shown, taken.sort());
  for (const name of shown) {
    const bytes = await readFile(new URL(`${name}.png`, folder));
    assert.ok(bytes.length < most, `${name} has ${bytes.length} bytes`);
    assert.ok(colours(PNG.sync.read(bytes)) > 24, name);
  }
});
