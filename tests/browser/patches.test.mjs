// All three kinds of patches in one page by real pointer events: a hole is filled, its inside displaced, a cage beside it dragged; the link
// and a reload hold it all.

import assert from "node:assert/strict";
import { test } from "node:test";
import { pentagon } from "./support/loops.mjs";
import { atRest, distance, drawn, point, wide } from "./support/model.mjs";
import { open, untilInspect } from "./support/page.mjs";
import { drag } from "./support/pointer.mjs";

const context = { permissions: ["clipboard-read", "clipboard-write"] };

/** The mean of some places of the window. */
const mean = (places) => [0, 1].map((axis) => places.reduce((sum, at) => sum + at[axis], 0) / places.length);

test("a hole with five sides is filled, displaced inside, a cage is dragged beside it; link and reload bring all of it", async () => {
  const body = JSON.stringify(pentagon());
  const extra = { "/spec.json": { type: "application/json", body } };
  const session = await open({ viewport: wide, context, extra, query: "?spec=spec.json" });
  try {
    const { page } = session;
    const opened = await atRest(page, ({ name }) => name === "Pentagon");
    const { screen } = opened.curves.find(({ id }) => id === 3);
    await page.keyboard.press("f");
    const at = screen[Math.floor(screen.length / 2)];
    await page.mouse.move(...at);
    await untilInspect(page, ({ hover, marked }) => hover === "curve 3" && marked.lines >= 5);
    await page.mouse.click(...at);
    const filled = await atRest(page, ({ act }) => act === "Fill");
    assert.deepEqual(filled.surfaces.map(({ kind }) => kind), ["Fill"]);

    // The inside follows the hand exactly; the boundary stays where its curves are.
    const middle = mean([1, 2, 3, 4, 5].map((id) => point(filled, id).screen));
    const to = [middle[0] + 10, middle[1] - 60];
    await page.keyboard.press("e");
    await drag(page, middle, to, {
      beforeRelease: () => untilInspect(page, ({ feet }) => feet.length === 1 && distance(feet[0].screen, to) < 2),
    });
    const displaced = await atRest(page, ({ act }) => act === "Displace");
    assert.deepEqual(displaced.points, filled.points, "no control has moved");

    // One more place moves along with the foot.
    const other = [middle[0] + 35, middle[1] + 20];
    await page.keyboard.down("Control");
    await page.mouse.click(...other);
    await page.keyboard.up("Control");
    const both = await atRest(page, ({ act }) => act === "Add foot");
    assert.equal(JSON.parse(both.document).displacements[1].items[0].foot.all.length, 2);

    // A cage beside it, and a vertex of it under the hand.
    await page.keyboard.press("q");
    await page.locator("#cage-size").fill("0.3");
    await page.locator("#cage-size").press("Enter");
    await page.mouse.click(130, 420);
    const caged = await atRest(page, ({ act }) => act === "Cage");
    const toEye = (entry) => distance(entry.at, caged.camera.eye);
    const own = caged.points.filter(({ id }) => !both.points.some((entry) => entry.id === id));
    assert.equal(own.length, 8);
    const top = own.reduce((a, b) => (toEye(b) < toEye(a) ? b : a));
    await page.mouse.move(...top.screen);
    await untilInspect(page, ({ hover }) => hover === `point ${top.id}`);
    const away = [top.screen[0] + 25, top.screen[1] - 30];
    await drag(page, top.screen, away, {
      beforeRelease: () => untilInspect(page, (state) => distance(point(state, top.id).screen, away) < 3),
    });
    const last = await atRest(page, ({ act }) => act === "Move");
    assert.deepEqual(last.surfaces.map(({ kind }) => kind).sort(), ["Cage", "Fill"]);
    await drawn(page);

    // The link and a reload hold all of it, and the same shapes come back.
    await page.locator("#link").click();
    await untilInspect(page, (state) => state.toast?.startsWith("Link copied"));
    const link = await page.evaluate(() => navigator.clipboard.readText());
    const friend = await session.visit(link, await session.browser.newContext({ viewport: wide }));
    const seen = await atRest(friend, ({ feet }) => feet.length === 2);
    await page.reload();
    const back = await atRest(page, ({ feet }) => feet.length === 2);
    for (const [state, how] of [[seen, "the link"], [back, "the reload"]]) {
      assert.equal(state.document, last.document, `${how} brings the very document`);
      for (const [k, { at }] of state.feet.entries()) assert.ok(distance(at, last.feet[k].at) < 1e-3, `${how} brings the feet`);
      for (const [k, ball] of state.balls.entries()) {
        assert.ok(distance(ball.centre, last.balls[k].centre) < 1e-3, `${how} brings the shapes`);
      }
    }
    session.assertQuiet();
  } finally {
    await session.close();
  }
});
