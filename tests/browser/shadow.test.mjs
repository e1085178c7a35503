// Region shadowing by real pointer events: what is marked, what is made, the fields of the shadow, refusals, undo.

import assert from "node:assert/strict";
import { test } from "node:test";
import { atRest, documentOf, drawn, picture, point, withDocument } from "./support/model.mjs";
import { until, untilInspect } from "./support/page.mjs";
import { discAndDome } from "./support/rings.mjs";

const shadowOf = (state) => JSON.parse(state.document).surfaces[1].regions?.[0]?.shadow;

/** The middle of the disc, as a picture shows it. */
function middle(state) {
  const places = [1, 2, 3, 4].map((id) => point(state, id).screen);
  return [0, 1].map((axis) => places.reduce((sum, place) => sum + place[axis], 0) / 4);
}

test("a disc takes on the relief of a dome, and strength, turn and undo are what they say", async () => {
  await withDocument(discAndDome, async (page, before) => {
    const [disc, dome] = [middle(before), point(before, 9).screen];
    await drawn(page);
    const flat = await picture(page);
    await page.keyboard.press("l");
    await untilInspect(page, ({ tool }) => tool === "shadow");
    await page.mouse.move(...disc);
    await untilInspect(page, ({ marked }) => marked.tinted === 1);
    await page.mouse.click(...disc);
    await untilInspect(page, ({ underWay }) => underWay);
    await page.mouse.click(disc[0] + 10, disc[1]);
    await untilInspect(page, ({ toast }) => /^This is the same surface/.test(toast ?? ""));
    await page.mouse.move(...dome);
    await untilInspect(page, ({ marked }) => marked.tinted === 2);
    await page.keyboard.press("Escape");
    await untilInspect(page, ({ underWay, tool }) => !underWay && tool === "shadow");
    await page.mouse.click(...disc);
    await untilInspect(page, ({ underWay }) => underWay);
    await page.mouse.click(...dome);
    const stamped = await atRest(page, ({ act }) => act === "Shadow");
    assert.equal(shadowOf(stamped).of, 2);
    await page.keyboard.press("Escape");
    await page.mouse.move(80, 300);
    await drawn(page);
    assert.notDeepEqual((await picture(page)).data, flat.data, "the relief is in the picture");

    await page.keyboard.press("v");
    await page.mouse.click(disc[0] + 30, disc[1] + 5);
    await until(page, () => document.getElementById("shadow-title").textContent === "Shadow of surface 2");
    await page.locator("#shadow-strength").fill("-0.5");
    await page.locator("#shadow-strength").press("Enter");
    await atRest(page, (state) => shadowOf(state).strength === -0.5);
    await page.locator("#shadow-turn").fill("90");
    await page.locator("#shadow-turn").press("Enter");
    const turned = await atRest(page, (state) => shadowOf(state).turn === Math.PI / 2);
    await page.locator("#free-shadow").click();
    const free = await atRest(page, (state) => shadowOf(state) === undefined);
    assert.equal(free.document, before.document);
    await page.locator("#shadow-properties").waitFor({ state: "hidden" });
    await page.keyboard.press("Control+z");
    const again = await atRest(page, ({ act }) => act === "Undo Shadow");
    assert.equal(again.document, turned.document);
    assert.ok(await documentOf(page));
  });
});

test("a stamp with a hole leaves the region as it is and says why; without the hole the shadow comes back by itself", async () => {
  await withDocument(discAndDome, async (page, before) => {
    const [disc, dome] = [middle(before), point(before, 9).screen];
    await page.keyboard.press("l");
    await untilInspect(page, ({ tool }) => tool === "shadow");
    await page.mouse.click(...disc);
    await untilInspect(page, ({ underWay }) => underWay);
    await page.mouse.click(...dome);
    const stamped = await atRest(page, ({ act }) => act === "Shadow");

    // A curve round the summit of the dome, and what is inside of it burnt out.
    await page.keyboard.press("d");
    await untilInspect(page, ({ tool }) => tool === "draw");
    const ring = [[26, 0], [0, -12], [-26, 0], [0, 18]].map(([x, y]) => [dome[0] + x, dome[1] + 14 + y]);
    for (const [index, place] of ring.entries()) {
      await page.mouse.click(...place);
      await untilInspect(page, ({ corners }) => corners === index + 1);
    }
    await page.mouse.click(...ring[0]);
    const drawn = await atRest(page, ({ act }) => act === "Draw");
    await page.keyboard.press("b");
    await untilInspect(page, ({ tool }) => tool === "burnout");
    await page.mouse.click(dome[0] + 8, dome[1] + 14);
    const burnt = await atRest(page, ({ act }) => act === "Burn out");
    assert.equal(burnt.surfaces.find(({ id }) => id === 2).summary.boundaries, 2);
    assert.deepEqual(shadowOf(burnt), shadowOf(stamped), "the document keeps the shadow");

    await page.keyboard.press("v");
    await page.mouse.click(disc[0] + 30, disc[1] + 5);
    const said = () => page.locator("#shadow-trouble").textContent();
    await page.locator("#shadow-trouble").waitFor({ state: "visible" });
    assert.match(await said(), /^It does not show: the stamp does not suit, it has 2 rims .* It comes back by itself when that is mended\.$/);
    if (process.env.PICTURES) await page.screenshot({ path: `${process.env.PICTURES}/shadow-trouble.png` });
    await page.keyboard.press("Control+z");
    await atRest(page, (state) => state.document === drawn.document);
    await page.locator("#shadow-trouble").waitFor({ state: "hidden" });
    assert.equal(await page.locator("#shadow-title").textContent(), "Shadow of surface 2");
  });
});
