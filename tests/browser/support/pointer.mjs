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

/**
 * Double clicks as fast as a hand does. The events are handed over without waiting for the page to deal with each:
 * their times are those of the hand, and a page that is busy drawing sees a double click all the same.
 */
export async function doubleClick(page, [x, y]) {
  const client = await page.context().newCDPSession(page);
  const mouse = (type, more) => client.send("Input.dispatchMouseEvent", { type, x, y, pointerType: "mouse", ...more });
  const left = (clickCount, buttons) => ({ button: "left", buttons, clickCount });
  await Promise.all([
    mouse("mouseMoved", {}),
    mouse("mousePressed", left(1, 1)),
    mouse("mouseReleased", left(1, 0)),
    mouse("mousePressed", left(2, 1)),
    mouse("mouseReleased", left(2, 0)),
  ]);
  await client.detach();
}

/**
 * Draws with a pen from `from` to `to` in `steps` moves; `button` is left for its tip, right for its barrel button.
 * `beforeRelease` is called with the pen still down.
 */
export async function pen(page, from, to, { steps = 24, pause = 8, button = "left", beforeRelease } = {}) {
  const client = await page.context().newCDPSession(page);
  const buttons = { left: 1, right: 2 }[button];
  const send = (type, [x, y], more) =>
    client.send("Input.dispatchMouseEvent", { type, x, y, pointerType: "pen", tiltX: 20, tiltY: -10, ...more });
  await send("mouseMoved", from, { force: 0 });
  await send("mousePressed", from, { button, buttons, clickCount: 1, force: 0.1 });
  for (let step = 1; step <= steps; step += 1) {
    const part = step / steps;
    const place = [0, 1].map((axis) => from[axis] + part * (to[axis] - from[axis]));
    // A hand presses now harder, now softer.
    await send("mouseMoved", place, { button, buttons, force: 0.1 + 0.8 * Math.abs(Math.sin(3 * part)) });
    await page.waitForTimeout(pause);
  }
  await beforeRelease?.();
  await send("mouseReleased", to, { button, buttons: 0, clickCount: 1, force: 0 });
  await client.detach();
}

/** Points with a pen that hovers over the page. */
export async function hoverWithPen(page, [x, y]) {
  const client = await page.context().newCDPSession(page);
  await client.send("Input.dispatchMouseEvent", { type: "mouseMoved", x, y, pointerType: "pen", force: 0 });
  await client.detach();
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

/** Taps with fingers at these places, all at once, as fast as a hand does (see `doubleClick`). */
export async function tap(page, ...places) {
  const client = await page.context().newCDPSession(page);
  const touchPoints = places.map(([x, y], id) => ({ id, x, y }));
  await Promise.all([
    client.send("Input.dispatchTouchEvent", { type: "touchStart", touchPoints }),
    client.send("Input.dispatchTouchEvent", { type: "touchEnd", touchPoints: [] }),
  ]);
  await client.detach();
}
