// Displacements by real pointer events: the inside of a surface is pulled, and nothing else gives way.

import assert from "node:assert/strict";
import { test } from "node:test";
import { assertOnCanvas, atRest, distance, drawn, onBareSurface, picture, pointAway, wide, withDocument } from "./support/model.mjs";
import { inspect, open, until, untilInspect, withPage } from "./support/page.mjs";
import { difference } from "./support/pixels.mjs";
import { drag } from "./support/pointer.mjs";
import { ringedDisc } from "./support/rings.mjs";

const context = { permissions: ["clipboard-read", "clipboard-write"] };
/** Pixels by which a foot may miss the pointer. */
const exactly = 2;

const displacedOf = (state) => JSON.parse(state.document).displacements?.[1];
const foot = (state, number) => state.feet.find((entry) => entry.number === number);
const value = (page, id, text) =>
  until(page, ([id, text]) => document.getElementById(id).value === text, [id, text], { timeout: 5000 });

test("a surface is pulled from inside, the foot goes where the hand does, undo and redo are exact", async () => {
  await withPage({ viewport: wide }, async (page) => {
    await pointAway(page);
    const before = await atRest(page);
    const seen = await picture(page);
    const [from, to] = onBareSurface(before);
    await assertOnCanvas(page, from, to);
    await page.keyboard.press("e");
    await page.mouse.move(...from);
    const wider = await untilInspect(page, (state) => state.tool === "displace" && state.marked.lines > 8);
    await value(page, "reach-range", "0");
    await page.mouse.wheel(0, 300);
    await untilInspect(page, ({ marked }) => marked.lines > 4 && marked.lines < wider.marked.lines);
    await page.keyboard.press("]");
    await page.locator("#reach-range").fill("0.2");
    await page.locator("#reach-range").press("Enter");
    await value(page, "reach-range", "0.2");

    await drag(page, from, to, {
      async beforeRelease() {
        const state = await untilInspect(page, (now) => now.feet.length === 1 && distance(foot(now, 1).screen, to) < exactly);
        assert.equal(state.document, before.document, "nothing is committed before the release");
      },
    });
    await pointAway(page);
    const after = await atRest(page, (state) => state.document !== before.document);
    assert.equal(after.act, "Displace");
    assert.equal(after.selection, "surface 1");
    assert.ok(distance(foot(after, 1).screen, to) < exactly, "it stays where it was let go");
    assert.equal(after.points.length, before.points.length, "no control was made");
    const [item] = displacedOf(after).items;
    assert.equal(item.range, 0.2);
    const shown = item.foot.at.map((x, axis) => x + item.by[axis]);
    assert.ok(distance(shown, foot(after, 1).at) < 0.01, "the document says what the picture shows");
    assert.ok(Math.abs(after.figures.energy / before.figures.energy - 1) < 1e-3, "the surface below is what it was");
    const changed = difference(seen, await picture(page));
    assert.ok(changed > 0.02, `the picture is another one in ${changed} of its pixels`);

    await page.keyboard.press("Control+z");
    const back = await atRest(page, (state) => state.document !== after.document);
    assert.equal(back.document, before.document, "undo brings the very document back");
    assert.equal(back.feet.length, 0);
    await page.keyboard.press("Control+Shift+Z");
    const again = await atRest(page, (state) => state.document !== before.document);
    assert.equal(again.document, after.document, "redo brings the second one back");
  });
});

test("what a displacement would move is tinted softly: pointed at, held, chosen; `PICTURES=folder` keeps the pictures", async () => {
  const photo = async (page, name) => {
    if (process.env.PICTURES) await page.screenshot({ path: `${process.env.PICTURES}/${name}.png` });
  };
  for (const colorScheme of ["light", "dark"]) {
    await withPage({ viewport: wide, context: { colorScheme } }, async (page) => {
      const before = await atRest(page);
      const [from, to] = onBareSurface(before);
      await page.keyboard.press("e");
      await pointAway(page);
      await untilInspect(page, (state) => state.tool === "displace" && state.marked.influence === 0);
      await drawn(page);
      const bare = await picture(page);
      await page.mouse.move(...from);
      const wider = await untilInspect(page, ({ marked }) => marked.influence > 20 && marked.lines > 4);
      await drawn(page);
      const tinted = difference(bare, await picture(page));
      assert.ok(tinted > 0.02, `${colorScheme}: ${tinted} of the picture is tinted`);
      await photo(page, `influence-${colorScheme}`);
      await page.locator("#reach-range").fill("-0.5");
      await page.locator("#reach-range").press("Enter");
      await page.mouse.move(from[0] + 1, from[1]);
      await untilInspect(page, ({ marked }) => marked.lines > 4 && marked.lines < wider.marked.lines);
      await drag(page, [from[0] + 1, from[1]], to, {
        async beforeRelease() {
          await untilInspect(page, (now) => now.feet.length === 1 && now.marked.influence > 20);
          await drawn(page);
          await photo(page, `influence-held-${colorScheme}`);
        },
      });
      await pointAway(page);
      const after = await atRest(page, (state) => state.document !== before.document && state.marked.influence > 20);
      await drawn(page);
      await photo(page, `influence-chosen-${colorScheme}`);
      // Over the foot it is the range of the foot that counts, not that of the tool.
      await page.locator("#reach-range").fill("0.6");
      await page.locator("#reach-range").press("Enter");
      await page.mouse.move(...foot(after, 1).screen);
      await page.waitForTimeout(300);
      const over = await untilInspect(page, ({ marked }) => marked.influence > 0);
      assert.equal(over.marked.influence, after.marked.influence);
      await page.keyboard.press("Escape");
      await untilInspect(page, (state) => state.tool === "shape" && state.marked.influence === 0);
    });
  }
});

test("a foot is taken again, changed by numbers, erased; all are dropped", async () => {
  await withPage({ viewport: wide }, async (page) => {
    const before = await atRest(page);
    const [from, to] = onBareSurface(before);
    await page.keyboard.press("e");
    await drag(page, from, to);
    const one = await atRest(page, ({ act }) => act === "Displace");
    const target = [to[0] + 25, to[1] + 10];
    await drag(page, foot(one, 1).screen, target);
    const moved = await atRest(page, ({ act }) => act === "Change displacement");
    assert.ok(distance(foot(moved, 1).screen, target) < exactly);
    assert.equal(displacedOf(moved).items.length, 1);

    // Numbers of the chosen one.
    await page.locator("#displaced-z").fill("0.25");
    await page.locator("#displaced-z").press("Enter");
    const typed = await atRest(page, (state) => displacedOf(state).items[0].by[2] === 0.25);
    await page.locator("#displaced-range").fill("-1");
    await page.locator("#displaced-range").press("Enter");
    await atRest(page, (state) => displacedOf(state).items[0].range === -1);
    await page.locator("#displaced-blend").selectOption({ label: "Bump" });
    await atRest(page, (state) => displacedOf(state).blending?.blend?.bump === 1);
    assert.notEqual(typed.document, moved.document);

    // Escape puts a drag back.
    const held = await inspect(page);
    const [x, y] = foot(held, 1).screen;
    await page.mouse.move(x, y);
    await page.mouse.down();
    await page.mouse.move(x + 40, y - 30, { steps: 6 });
    await untilInspect(page, (state) => distance(foot(state, 1).screen, [x + 40, y - 30]) < exactly);
    await page.keyboard.press("Escape");
    await page.mouse.up();
    const given = await atRest(page, (state) => distance(foot(state, 1).screen, [x, y]) < exactly);
    assert.equal(given.document, held.document);

    await page.locator('#displaced-list [data-subject="1"]').click();
    await page.locator("#erase-displacement").click();
    const erased = await atRest(page, ({ act }) => act === "Erase displacement");
    assert.equal(erased.feet.length, 0);
    await page.locator("#drop-displacements").waitFor({ state: "hidden" });
    await page.keyboard.press("Control+z");
    await atRest(page, ({ act }) => act === "Undo Erase displacement");
    await page.locator("#drop-displacements").click();
    const dropped = await atRest(page, ({ act }) => act === "Drop displacements");
    assert.equal(displacedOf(dropped), undefined);
    await page.mouse.move(80, 300);
    await page.locator("#view").focus();
    await page.keyboard.press("Escape");
    await untilInspect(page, ({ tool }) => tool === "shape");
  });
});

test("a curve inside a surface is dragged as a whole, taken again anywhere, and its rim is no foot", async () => {
  await withDocument(ringedDisc, async (page, before) => {
    const seen = await picture(page);
    const [rim, ring] = [1, 2].map((id) => before.curves.find((curve) => curve.id === id).screen);
    const front = (places) => places.reduce((a, b) => (b[1] > a[1] ? b : a));
    await page.keyboard.press("e");
    await page.mouse.move(...front(ring));
    await untilInspect(page, ({ hover, marked }) => hover === "curve 2" && marked.lines > 8);
    // The rim stays where it is: over it, what the tool takes is the surface, or nothing.
    await page.mouse.move(...front(rim));
    await untilInspect(page, ({ hover }) => hover !== "curve 1" && hover !== "curve 2");

    const from = front(ring);
    const by = [6, -70];
    const to = from.map((x, axis) => x + by[axis]);
    await drag(page, from, to, {
      async beforeRelease() {
        const state = await untilInspect(page, ({ feet }) => feet.length === 1 && feet[0].places > 16);
        assert.equal(state.document, before.document, "nothing is committed before the release");
      },
    });
    await pointAway(page);
    const raised = await atRest(page, ({ act }) => act === "Displace");
    const [item] = displacedOf(raised).items;
    assert.deepEqual(item.foot, { along: 2 });
    assert.ok(Math.hypot(...item.by) > 0.2, `${item.by}`);
    assert.equal(raised.points.length, before.points.length, "no control was made");
    assert.ok(difference(seen, await picture(page)) > 0.02, "the ring stands up");
    // The first place of the curve has moved by the vector that the document says.
    const first = before.curves[1].at[0];
    assert.ok(distance(first.map((x, axis) => x + item.by[axis]), foot(raised, 1).at) < 0.01);

    // Elsewhere on the raised curve it is taken again; Escape puts that back.
    await page.mouse.move(...to);
    const over = await untilInspect(page, ({ marked, hover }) => hover !== null && marked.lines === 1);
    assert.equal(over.feet[0].places > 16, true);
    await page.mouse.down();
    await page.mouse.move(to[0], to[1] - 40, { steps: 6 });
    await untilInspect(page, (state) => distance(foot(state, 1).screen, foot(raised, 1).screen) > 20);
    await page.keyboard.press("Escape");
    await page.mouse.up();
    const given = await atRest(page, (state) => distance(foot(state, 1).screen, foot(raised, 1).screen) < exactly);
    assert.equal(given.document, raised.document);
    await drag(page, to, [to[0], to[1] - 30]);
    const higher = await atRest(page, ({ act }) => act === "Change displacement");
    assert.deepEqual(displacedOf(higher).items[0].foot, { along: 2 });
    assert.ok(displacedOf(higher).items[0].by[2] > item.by[2] + 0.05);

    // Its numbers are those of any displacement.
    await page.locator("#displaced-z").fill("0.3");
    await page.locator("#displaced-z").press("Enter");
    await atRest(page, (state) => displacedOf(state).items[0].by[2] === 0.3);
    for (let acts = 3; acts > 0; acts -= 1) {
      const { document } = await inspect(page);
      await page.locator("#undo").click();
      await atRest(page, (state) => state.document !== document);
    }
    assert.equal((await inspect(page)).document, before.document);
  });
});

test("a displacement reaches further along a direction, before it is made and after", async () => {
  await withPage({ viewport: wide }, async (page) => {
    const before = await atRest(page);
    const [from, to] = onBareSurface(before);
    await page.keyboard.press("e");
    await page.mouse.move(...from);
    await untilInspect(page, ({ marked }) => marked.lines > 8);
    const round = await picture(page);
    assert.equal(await page.locator("#reach-along").isVisible(), false, "all round there is no direction");
    const type = async (id, text) => {
      await page.locator(`#${id}`).fill(text);
      await page.locator(`#${id}`).press("Enter");
    };
    await type("reach-times", "4");
    await page.locator("#reach-along").waitFor({ state: "visible" });
    await value(page, "reach-x", "1");
    await page.mouse.move(...from);
    await untilInspect(page, ({ marked, settled }) => settled && marked.lines > 8);
    await drawn(page);
    const long = await picture(page);
    assert.ok(difference(round, long) > 0.001, "the line is another one");
    await type("reach-y", "1");
    await type("reach-x", "0");
    await type("reach-y", "0");
    await untilInspect(page, () => true);
    assert.match(await page.locator("#number-error").textContent(), /A direction has a length/);
    await page.locator("#reach-y").press("Escape");
    await value(page, "reach-y", "1");
    await type("reach-times", "100");
    assert.match(await page.locator("#number-error").textContent(), /between 1\/64 and 64/);
    await type("reach-times", "3");

    await drag(page, from, to);
    const made = await atRest(page, ({ act }) => act === "Displace");
    assert.deepEqual(displacedOf(made).items[0].direction, { along: [0, 1, 0], times: 3 });
    // The chosen one shows how far it reaches while nothing is pointed at, and its numbers.
    await page.mouse.move(80, 300);
    await untilInspect(page, ({ hover, marked }) => hover === null && marked.lines > 4);
    await value(page, "displaced-times", "3");
    await value(page, "displaced-along-y", "1");
    const seen = await picture(page);
    await type("displaced-along-x", "2");
    const turned = await atRest(page, ({ act }) => act === "Change displacement");
    assert.deepEqual(displacedOf(turned).items[0].direction, { along: [2, 1, 0], times: 3 });
    await page.mouse.move(80, 300);
    assert.ok(difference(seen, await picture(page)) > 0.005, "the shape is another one");
    await type("displaced-times", "1");
    const all = await atRest(page, (state) => displacedOf(state).items[0].direction === undefined);
    assert.notEqual(all.document, turned.document);
    await page.locator("#displaced-along").waitFor({ state: "hidden" });
    for (let acts = 3; acts > 0; acts -= 1) {
      const { document } = await inspect(page);
      await page.locator("#undo").click();
      await atRest(page, (state) => state.document !== document);
    }
    assert.equal((await inspect(page)).document, before.document);
  });
});

test("a displaced surface is baked: the picture stays, the displacements go, and undo brings them back", async () => {
  await withPage({ viewport: wide }, async (page) => {
    const before = await atRest(page);
    const [from, to] = onBareSurface(before);
    await page.keyboard.press("e");
    await drag(page, from, to);
    await page.keyboard.press("v");
    await pointAway(page);
    const displaced = await atRest(page, ({ act, toast }) => act === "Displace" && toast === null);
    const seen = await picture(page);
    await page.locator("#bake").click();
    await pointAway(page);
    const baked = await atRest(page, ({ act, toast }) => act === "Bake" && toast === null);
    assert.deepEqual(baked.surfaces.map(({ id, kind }) => [id, kind]), [[1, "Mesh"]]);
    const { meshes, displacements, curves, points } = JSON.parse(baked.document);
    assert.equal(meshes[1].vertices.length, displaced.surfaces[0].vertex_count);
    assert.equal(displacements, undefined);
    assert.deepEqual([Object.keys(curves).length, Object.keys(points).length], [1, 4], "its boundary stays");
    // Three raised points are gone, and the curve is of another colour now: nothing holds on to it.
    const changed = difference(seen, await picture(page));
    assert.ok(changed < 0.02, `the picture is another one in ${changed} of its pixels`);
    await page.locator("#bake").waitFor({ state: "hidden" });
    await page.locator('#scene-list [data-subject="surface 1"]', { hasText: "mesh" }).waitFor();

    // It turns inside out, and is displaced once more.
    await page.locator("#reverse").click();
    await atRest(page, ({ act }) => act === "Reverse");
    await page.keyboard.press("e");
    await drag(page, to, [to[0] + 20, to[1] - 10]);
    const again = await atRest(page, ({ act, feet }) => act === "Displace" && feet.length === 1);
    assert.equal(again.surfaces[0].kind, "Mesh");
    for (const act of ["Displace", "Reverse", "Bake"]) {
      await page.keyboard.press("Control+z");
      await atRest(page, (state) => state.act === `Undo ${act}`);
    }
    assert.equal((await inspect(page)).document, displaced.document);
  });
});

test("a displaced surface travels by link and comes back after a reload", async () => {
  const session = await open({ viewport: wide, context });
  try {
    const { page } = session;
    const [from, to] = onBareSurface(await atRest(page));
    await page.keyboard.press("e");
    await drag(page, from, to);
    const sent = await atRest(page, ({ act }) => act === "Displace");
    await page.locator("#link").click();
    await untilInspect(page, (state) => state.toast?.startsWith("Link copied"));
    const link = await page.evaluate(() => navigator.clipboard.readText());
    const other = await session.browser.newContext({ viewport: wide });
    const friend = await session.visit(link, other);
    const seen = await atRest(friend, ({ feet }) => feet.length === 1);
    assert.equal(seen.document, sent.document);
    assert.ok(distance(foot(seen, 1).at, foot(sent, 1).at) < 0.01);
    await page.reload();
    const back = await atRest(page, ({ feet }) => feet.length === 1);
    assert.equal(back.document, sent.document);
    assert.ok(distance(foot(back, 1).at, foot(sent, 1).at) < 0.01);
    await drawn(page);
    session.assertQuiet();
  } finally {
    await session.close();
  }
});
