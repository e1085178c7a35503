// Real pointer events, as a hand makes them.

/**
 * Drags from `from` to `to` (`[x, y]` in CSS pixels of the page) in `steps` moves, `pause` milliseconds apart.
 * `button`: left, middle or right; `modifiers`: keys held meanwhile; `beforeRelease`: called with the button still down.
 */
export async function drag(page, from, to, { steps = 24, pause = 8, button = "left", modifiers = [], beforeRelease } = {}) {
  for (const key of modifiers) await page.keyboard.down(key);
  await page.mouse.move(...from);
  await page.mouse.down({ button });
  for (let step = 1; step <= steps; step += 1) {
    const part = step / steps;
    await page.mouse.move(from[0] + part * (to[0] - from[0]), from[1] + part * (to[1] - from[1]));
    await page.waitForTimeout(pause);
  }
  await beforeRelease?.();
  await page.mouse.up({ button });
  for (const key of [...modifiers].reverse()) await page.keyboard.up(key);
}

/** The middle of an element, in CSS pixels of the page. */
export async function middle(page, selector) {
  const box = await page.locator(selector).boundingBox();
  return [box.x + box.width / 2, box.y + box.height / 2];
}

/**
 * Touches with any number of fingers at once. `paths` holds one list of `[x, y]` for each finger, all of the same
 * length; the fingers go down together, move together and lift together.
 */
export async function touch(page, paths, { pause = 16 } = {}) {
  const client = await page.context().newCDPSession(page);
  const points = (moment) => paths.map((path, id) => ({ id, x: path[moment][0], y: path[moment][1] }));
  await client.send("Input.dispatchTouchEvent", { type: "touchStart", touchPoints: points(0) });
  for (let moment = 1; moment < paths[0].length; moment += 1) {
    await page.waitForTimeout(pause);
    await client.send("Input.dispatchTouchEvent", { type: "touchMove", touchPoints: points(moment) });
  }
  await client.send("Input.dispatchTouchEvent", { type: "touchEnd", touchPoints: [] });
  await client.detach();
}
