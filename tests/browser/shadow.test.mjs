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
    await page.keyboard.press("o");
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
