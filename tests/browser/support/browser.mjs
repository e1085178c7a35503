// Starts the Chromium of this machine with WebGPU by software.

import { readFileSync } from "node:fs";
import { chromium } from "playwright-core";

// The wasm test runner reads the same file: one place for the flags.
const settings = JSON.parse(readFileSync(new URL("../webdriver.json", import.meta.url), "utf8"));
const flags = settings["goog:chromeOptions"].args.map((flag) => `--${flag}`);

/** A browser; `cargo xtask test` says in CHROME which. Further flags can be given; `webgpu: false` leaves those out that bring it. */
export function launch({ more = [], webgpu = true } = {}) {
  const executablePath = process.env.CHROME ?? "/usr/bin/chromium";
  const wanted = flags.filter((flag) => webgpu || !/webgpu|vulkan/i.test(flag));
  return chromium.launch({ executablePath, args: [...wanted, ...more] });
}
