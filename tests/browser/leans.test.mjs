// How a fill leaves its sides, set in its properties; corners picked along a chain of curves; a generalised Bézier patch as a file.

import assert from "node:assert/strict";
import { test } from "node:test";
import { atRest, documentOf, drawn, point, pointAway, withDocument } from "./support/model.mjs";
import { inspect, until, untilInspect } from "./support/page.mjs";
import { pentagon, twoLoops } from "./support/loops.mjs";

async function picture(page, name) {
  await drawn(page);
  if (process.env.PICTURES) await page.screenshot({ path: `${process.env.PICTURES}/${name}.png` });
}

/** Types into a field that a click has focused. */
async function type(page, id, text) {
  const field = page.locator(`#${id}`);
  await field.click();
  await field.fill(text);
  await page.keyboard.press("Enter");
}

const valueIs = (page, id, value) => until(page, ([id, value]) => document.getElementById(id)?.value === value, [id, value], { timeout: 5000 });

test("a side of a patch is turned and strengthened with the pointer, refused where it cannot be, taken back and kept", async () => {
  const filled = pentagon("Leans");
  filled.fills = { 1: { sides: [1, 2, 3, 4, 5].map((curve) => ({ curve, from: curve, to: (curve % 5) + 1 })) } };
  await withDocument(filled, async (page, opened) => {
    const list = page.locator('#scene-list [data-subject="surface 1"]');
    await list.click();
    await valueIs(page, "side-1-turn", "0");
    await valueIs(page, "side-5-strength", "1");
    await picture(page, "lean-fair");

    // The side shows itself while the pointer is on its row.
    await page.locator('#fill-sides [data-side="1"] label').first().hover();
    await untilInspect(page, ({ marked }) => marked.lines === 1);
    await pointAway(page);
    await untilInspect(page, ({ marked }) => marked.lines === 0);

    await type(page, "side-2-turn", "45");
    const turned = await atRest(page, ({ act, document }) => act === "Lean" && document !== opened.document);
    const side = () => documentOf(page).then(({ fills }) => fills[1].sides[1]);
    assert.ok(Math.abs((await side()).turn - Math.PI / 4) < 1e-12);
    await valueIs(page, "side-2-turn", "45");
    await type(page, "side-2-strength", "2,5");
    const strong = await atRest(page, ({ document }) => document !== turned.document);
    assert.equal((await side()).strength, 2.5);
    await picture(page, "lean-strong");
    await until(page, () => /off its planes by at most/.test(document.getElementById("fill-figures").textContent));

    for (const [field, text] of [["turn", "91"], ["turn", "steep"], ["strength", "0"], ["strength", "6"]]) {
      await type(page, `side-3-${field}`, text);
      await until(page, () => document.getElementById("number-error").checkVisibility(), null, { timeout: 5000 });
      assert.equal(await page.locator(`#side-3-${field}`).getAttribute("aria-invalid"), "true");
      await page.locator(`#side-3-${field}`).focus();
      await page.keyboard.press("Escape");
      await valueIs(page, `side-3-${field}`, field === "turn" ? "0" : "1");
    }
    assert.equal((await inspect(page)).document, strong.document);

    // Both acts are taken back and done again.
    for (const [key, last] of [["Control+z", opened], ["Control+Shift+z", strong]]) {
      for (let acts = 0; acts < 2; acts += 1) {
        const { document } = await inspect(page);
        await page.keyboard.press(key);
        await atRest(page, (state) => state.document !== document);
      }
      assert.equal((await inspect(page)).document, last.document);
      await valueIs(page, "side-2-strength", last === opened ? "1" : "2.5");
    }

    // It is there after a reload, and an empty field is fair again.
    await page.reload();
    await atRest(page, ({ document }) => document === strong.document);
    await list.click();
    await valueIs(page, "side-2-turn", "45");
    await type(page, "side-2-turn", "");
    await atRest(page, (state) => JSON.parse(state.document).fills[1].sides[1].turn === undefined);
    await valueIs(page, "side-2-turn", "0");
  });
});

test("what follows a side that leans goes with it, and has no turn of its own", async () => {
  await withDocument(twoLoops("Follows"), async (page, opened) => {
    await page.keyboard.press("f");
    const middle = (id) => {
      const { screen } = opened.curves.find((curve) => curve.id === id);
      return screen[Math.floor(screen.length / 2)];
    };
    for (const curve of [6, 3]) {
      const { document } = await inspect(page);
      await page.mouse.click(...middle(curve));
      await atRest(page, (state) => state.document !== document);
    }
    await page.keyboard.press("Escape");
    const { fills } = await documentOf(page);
    const leader = fills[1].sides.findIndex(({ curve }) => curve === 7) + 1;
    const follower = fills[2].sides.findIndex(({ curve }) => curve === 7) + 1;
    assert.equal(fills[2].sides[follower - 1].planes, 1);
    await page.locator('#scene-list [data-subject="surface 1"]').click();
    await type(page, `side-${leader}-turn`, "-30");
    await atRest(page, ({ act }) => act === "Lean");
    await page.locator('#scene-list [data-subject="surface 2"]').click();
    await until(page, () => document.getElementById("properties-title").textContent === "Surface 2");
    await until(page, (at) => /planes of surface 1/.test(document.querySelector(`#fill-sides [data-side="${at}"]`)?.textContent), follower - 1);
    await valueIs(page, `side-${follower}-strength`, "1");
    assert.equal(await page.locator(`#side-${follower}-turn`).count(), 0);
    await page.locator("#seams summary").click();
    const angle = () => /gap \S+ · (\S+)°/.exec(document.getElementById("seam-list").textContent)?.[1];
    await until(page, angle);
    const told = await page.evaluate(angle);
    assert.ok(Number(told) < 0.1, `they meet at ${told}°`);
    await picture(page, "lean-follows");
  });
});

test("corners inside the curves of a chain are picked by their points", async () => {
  const points = { 1: [-1, 0, 0], 2: [0, -0.9, 0.3], 3: [1, 0, 0], 4: [0, 0.9, 0.3] };
  const open = (...through) => ({ through, closed: false });
  const chain = { ductile: 1, name: "Chain", points, curves: { 1: open(1, 2, 3), 2: open(3, 4, 1) } };
  await withDocument(chain, async (page, opened) => {
    await page.keyboard.press("f");
    await untilInspect(page, ({ tool }) => tool === "fill");
    await page.locator("#new-fill-join").selectOption({ label: "Positions" });
    for (const id of [2, 4]) await page.mouse.click(...point(opened, id).screen);
    await untilInspect(page, ({ marked }) => marked.points === 2);
    await page.keyboard.press("Enter");
    const filled = await atRest(page, ({ act }) => act === "Fill");
    const { sides } = JSON.parse(filled.document).fills[1];
    assert.deepEqual(sides.map(({ from }) => from).sort(), [1, 2, 3, 4]);
    await picture(page, "chain-corners");
    await page.keyboard.press("Control+z");
    await atRest(page, ({ document }) => document === opened.document);
  });
});

test("a generalised Bézier patch is filled between its ribbons; a bad line is named", async () => {
  const corners = [[-1, -1], [1, -1], [1, 1], [-1, 1]];
  const row = (at, share) => corners.map(([x, y], k) => [0, 1, 2].map((j) => at([x, y], corners[(k + 1) % 4], j / 3).map((v) => v * share)));
  const along = ([a, b], [c, d], t) => [a + (c - a) * t, b + (d - b) * t];
  const lines = ["4 3", "0 0 0.5", ...row(along, 1).flat().map(([x, y]) => `${x} ${y} 0`), ...corners.map(([x, y]) => `${x / 3} ${y / 3} 0.4`)];
  const file = (name, text) => ({ name, mimeType: "", buffer: Buffer.from(text) });
  await withDocument(pentagon("Text"), async (page, opened) => {
    await page.locator("#file").setInputFiles(file("patch.gbp", `${lines.join("\n")}\n`));
    const filled = await atRest(page, ({ act }) => act === "Fill");
    const { ribbons } = (await documentOf(page)).fills[1];
    assert.deepEqual(ribbons.map(({ row0, row1 }) => [row0.length, row1.length]), [[4, 4], [4, 4], [4, 4], [4, 4]]);
    assert.deepEqual(ribbons[0].row1[1], [-1 / 3, -1 / 3, 0.4]);
    await page.locator("#file").setInputFiles(file("bad.gbp", lines.with(6, "1 2").join("\n")));
    const bad = await untilInspect(page, ({ banners }) => banners.length > 0);
    assert.match(bad.banners[0], /line 7: here three numbers/);
    assert.equal(bad.document, filled.document);
    assert.notEqual(filled.document, opened.document);
  });
});
