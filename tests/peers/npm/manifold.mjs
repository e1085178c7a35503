// manifold-3d (WebAssembly) on the torus of the benches, as the Rust program beside it wrote it: node manifold.mjs TORUS.obj DX
//
// It has no isotropic remeshing: `refineToLength` only splits and `simplify` only collapses. So what is compared is the boolean of
// the torus with itself moved along x, which goes on from the lines that our `meet` finds to the finished solid.

import { readFileSync } from "node:fs";
import { performance } from "node:perf_hooks";
import Module from "manifold-3d";

const [path, by] = [process.argv[2], Number(process.argv[3])];
const module = await Module();
module.setup();
const { Manifold, Mesh } = module;

const words = readFileSync(path, "utf8").split("\n").map((line) => line.trim().split(/\s+/));
const vertices = words.filter(([kind]) => kind === "v").flatMap((w) => w.slice(1, 4).map(Number));
const faces = words.filter(([kind]) => kind === "f").flatMap((w) => w.slice(1, 4).map((corner) => parseInt(corner, 10) - 1));
const mesh = new Mesh({ numProp: 3, vertProperties: Float32Array.from(vertices), triVerts: Uint32Array.from(faces) });

const REPEATS = 15;
function least(work) {
  const times = [];
  let found;
  for (let k = 0; k < REPEATS; k += 1) {
    const start = performance.now();
    found = work();
    times.push(performance.now() - start);
  }
  return [Math.min(...times), found];
}

// What it does is done when somebody asks for a number.
const [reading, torus] = least(() => {
  const solid = new Manifold(mesh);
  solid.numTri();
  return solid;
});
const moved = torus.translate([by, 0, 0]);
moved.numTri();
const [joining, both] = least(() => {
  const solid = torus.add(moved);
  solid.numTri();
  return solid;
});
const [splitting, fine] = least(() => {
  const solid = torus.refineToLength(0.108);
  solid.numTri();
  return solid;
});
console.log(`| manifold-3d: taking the mesh in | ${reading.toFixed(0)} ms | ${torus.numTri()} triangles |`);
console.log(`| manifold-3d: union, the whole solid | ${joining.toFixed(0)} ms | ${both.numTri()} triangles |`);
console.log(`| manifold-3d: refineToLength(0.108), which only splits | ${splitting.toFixed(0)} ms | ${fine.numTri()} triangles |`);
