// What is on the screen. A WebGPU canvas can only be read while it is being presented, so these are screenshots.

import { PNG } from "pngjs";

/** The pixels of an element, or of the whole page: `{ width, height, data }` with four bytes (RGBA) a pixel. */
export async function pixels(page, selector) {
  const target = selector ? page.locator(selector) : page;
  return PNG.sync.read(await target.screenshot({ animations: "disabled" }));
}

/** The colour at a point of the picture, as `[r, g, b]`. */
export function at(picture, x, y) {
  const start = 4 * (Math.round(y) * picture.width + Math.round(x));
  return [...picture.data.subarray(start, start + 3)];
}

/** How many different colours there are, counted with `bits` bits a channel so that dithering does not matter. */
export function colours(picture, bits = 5) {
  const seen = new Set();
  const shift = 8 - bits;
  for (let i = 0; i < picture.data.length; i += 4) {
    const [r, g, b] = picture.data.subarray(i, i + 3);
    seen.add(((r >> shift) << (2 * bits)) | ((g >> shift) << bits) | (b >> shift));
  }
  return seen.size;
}

/** The part of the pixels, from 0 to 1, that differ by more than `tolerance` in some channel. */
export function difference(one, other, tolerance = 8) {
  if (one.width !== other.width || one.height !== other.height) return 1;
  let count = 0;
  for (let i = 0; i < one.data.length; i += 4) {
    const differs = [0, 1, 2].some((channel) => Math.abs(one.data[i + channel] - other.data[i + channel]) > tolerance);
    count += differs ? 1 : 0;
  }
  return count / (one.width * one.height);
}
