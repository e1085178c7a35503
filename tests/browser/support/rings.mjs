// Documents for the tests of surgery: rings of four points, with or without a disc.

/** Four points on a circle, counted from `first`. */
function circle(first, radius, z = 0) {
  const places = [[radius, 0, z], [0, radius, z], [-radius, 0, z], [0, -radius, z]];
  return Object.fromEntries(places.map((place, index) => [first + index, place]));
}

const through = (first) => ({ through: [0, 1, 2, 3].map((index) => first + index), closed: true });

/** A disc with a closed curve in it: surface 1, its rim curve 1, the curve in it 2. */
export const ringedDisc = {
  ductile: 1,
  name: "Ringed disc",
  spacing: 0.1,
  points: { ...circle(1, 1), ...circle(5, 0.5) },
  curves: { 1: through(1), 2: through(5) },
  surfaces: {
    1: {
      skeleton: {
        vertices: [1, 2, 3, 4, 5, 6, 7, 8],
        triangles: [
          ...[0, 1, 2, 3].flatMap((i) => [[i, (i + 1) % 4, 4 + i], [(i + 1) % 4, 4 + ((i + 1) % 4), 4 + i]]),
          [4, 5, 6],
          [4, 6, 7],
        ],
        curves: [{ curve: 1, along: [0, 1, 2, 3] }, { curve: 2, along: [4, 5, 6, 7] }],
      },
    },
  },
};

/** A disc with a hole between two arcs that meet at both ends: surface 1, its rim curve 1, the arcs 2 and 3. */
export const arcedHole = {
  ...ringedDisc,
  name: "Hole between arcs",
  points: { ...circle(1, 1), ...circle(5, 0.5) },
  curves: { 1: through(1), 2: { through: [5, 6, 7], closed: false }, 3: { through: [7, 8, 5], closed: false } },
  surfaces: {
    1: {
      skeleton: {
        vertices: [1, 2, 3, 4, 5, 6, 7, 8],
        triangles: ringedDisc.surfaces[1].skeleton.triangles.slice(0, 8),
        curves: [{ curve: 1, along: [0, 1, 2, 3] }, { curve: 2, along: [4, 5, 6] }, { curve: 3, along: [6, 7, 4] }],
      },
    },
  },
};

/** Two free circles over one another, curves 1 and 2, the upper one half as wide. */
export const twoRings = {
  ductile: 1,
  name: "Two rings",
  spacing: 0.12,
  points: { ...circle(1, 1), ...circle(5, 0.5, 0.8) },
  curves: { 1: through(1), 2: through(5) },
};

/** A disc, surface 1 with its rim curve 1, and a free circle over it, curve 2. */
export const ringOverDisc = {
  ...twoRings,
  name: "Ring over disc",
  points: { ...circle(1, 1), ...circle(5, 0.5, 0.3) },
  surfaces: {
    1: {
      skeleton: {
        vertices: [1, 2, 3, 4],
        triangles: [[0, 1, 2], [0, 2, 3]],
        curves: [{ curve: 1, along: [0, 1, 2, 3] }],
      },
    },
  },
};

/** Two flat discs over one another: surfaces 1 and 2 with their rims, curves 1 and 2. */
export const twoDiscs = {
  ...twoRings,
  name: "Two discs",
  points: { ...circle(1, 0.8), ...circle(5, 0.8, 0.9) },
  surfaces: Object.fromEntries(
    [[1, 1], [2, 5]].map(([id, first]) => [
      id,
      {
        skeleton: {
          vertices: [first, first + 1, first + 2, first + 3],
          triangles: [[0, 1, 2], [0, 2, 3]],
          curves: [{ curve: id, along: [0, 1, 2, 3] }],
        },
      },
    ]),
  ),
};

/** A flat disc, surface 1 with its rim curve 1, and a dome through it that a point in its middle holds up: surface 2, rim curve 2. */
export const domeThroughDisc = {
  ...twoRings,
  name: "Dome through a disc",
  points: { ...circle(1, 1.2, 0.25), ...circle(5, 0.8), 9: [0, 0, 0.6] },
  surfaces: {
    1: twoDiscs.surfaces[1],
    2: {
      skeleton: {
        vertices: [5, 6, 7, 8, 9],
        triangles: [0, 1, 2, 3].map((i) => [i, (i + 1) % 4, 4]),
        curves: [{ curve: 2, along: [0, 1, 2, 3] }],
      },
    },
  },
};

/** A flat disc, surface 1 with its rim curve 1, and over it a bowl, surface 2 with its rim curve 2, whose lowest place is point 9. */
export const bowlOverDisc = {
  ...domeThroughDisc,
  name: "Bowl over a disc",
  points: { ...circle(1, 1.2), ...circle(5, 0.8, 0.9), 9: [0, 0, 0.5] },
};

/** A flat disc, surface 1 with its rim curve 1, and beside it a dome held up by point 9: surface 2, rim curve 2. */
export const discAndDome = {
  ...domeThroughDisc,
  name: "Disc and dome",
  points: Object.fromEntries(
    Object.entries({ ...circle(1, 0.8), ...circle(5, 0.8), 9: [0, 0, 0.5] }).map(([id, [x, y, z]]) => [
      id,
      [x + (id < 5 ? -1.1 : 1.1), y, z],
    ]),
  ),
};

/** A Möbius strip, surface 1, with a curve along its core, curve 1: five quadrilaterals, halved by the core. */
function strip() {
  const [points, vertices, triangles] = [{}, [1, 2, 3, 4, 5], []];
  for (let k = 0; k < 5; k += 1) {
    const turn = (2 * Math.PI * k) / 5;
    const [cos, sin] = [Math.cos(turn), Math.sin(turn)];
    const short = (place) => place.map((x) => Number(x.toFixed(4)));
    points[k + 1] = short([2 * cos, 2 * sin, 0]);
    for (const side of [0.6, -0.6]) {
      const radius = 2 + side * Math.cos(turn / 2);
      vertices.push(short([radius * cos, radius * sin, side * Math.sin(turn / 2)]));
    }
    const next = (k + 1) % 5;
    const [high, low] = [5 + 2 * k, 6 + 2 * k];
    // Once round, what was above is below.
    const [nextHigh, nextLow] = k === 4 ? [6, 5] : [high + 2, low + 2];
    triangles.push([k, next, high], [next, nextHigh, high], [k, next, low], [next, nextLow, low]);
  }
  const curves = [{ curve: 1, along: [0, 1, 2, 3, 4] }];
  return { points, skeleton: { vertices, triangles, curves } };
}

const { points: along, skeleton } = strip();

export const moebius = {
  ductile: 1,
  name: "Möbius strip with its core",
  spacing: 0.35,
  points: along,
  curves: { 1: { through: [1, 2, 3, 4, 5], closed: true } },
  surfaces: { 1: { skeleton } },
};
