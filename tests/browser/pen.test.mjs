// A pen: all that a mouse can do, and its pressure means nothing.

import assert from "node:assert/strict";
import { test } from "node:test";
import { atRest, distance, newPoints, onBareSurface, point, wide } from "./support/model.mjs";
import { untilInspect, withPage } from "./support/page.mjs";
import { hoverWithPen, pen } from "./support/pointer.mjs";

/** Pixels by which a control may miss the pen. */
const exactly = 2;

test("a pen points, pulls and turns the view as a mouse does", async () => {
  await withPage({ viewport: wide }, async (page) => {
    const before = await atRest(page);
    const from = point(before, 7).screen;
    const to = [from[0] - 12, from[1] - 70];
    await hoverWithPen(page, from);
    await untilInspect(page, ({ hover }) => hover === "point 7");
    await pen(page, from, to, {
      async beforeRelease() {
        await untilInspect(page, (now) => now.held === 7 && distance(point(now, 7).screen, to) < exactly);
      },
    });
    const after = await atRest(page, (state) => state.document !== before.document);
    assert.ok(distance(point(after, 7).screen, to) < exactly, "the point is where the pen let go, however hard it pressed");
    assert.deepEqual(newPoints(after, before), []);
    assert.deepEqual(after.camera, before.camera, "the view stays");

    const [bare, up] = onBareSurface(after);
    await pen(page, bare, up);
    const pulled = await atRest(page, (state) => state.document !== after.document);
    const [made] = newPoints(pulled, after);
    assert.ok(distance(made.screen, up) < exactly, `a bare place: ${made.screen} at ${up}`);

    await pen(page, bare, [bare[0] + 60, bare[1]], { button: "right", steps: 8 });
    const turned = await untilInspect(page, ({ camera }) => distance(camera.forward, after.camera.forward) > 0.1);
    assert.equal(turned.document, pulled.document, "the barrel button turns the view");
    assert.equal((await atRest(page)).held, null);
  });
});
