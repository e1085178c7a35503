// Documents of curves that bound loops.

/** Five bent curves around a hole: 1 to 5 are its corners, 6 to 10 the middles of the curves. */
export function pentagon(name = "Pentagon") {
  const [points, curves] = [{}, {}];
  for (let k = 0; k < 5; k += 1) {
    const at = (turn, radius, z) => [radius * Math.cos(turn), radius * Math.sin(turn), z].map((x) => Number(x.toFixed(3)));
    points[k + 1] = at((2 * Math.PI * k) / 5, 1, 0);
    points[k + 6] = at((2 * Math.PI * (k + 0.5)) / 5, 0.86, 0.2);
    curves[k + 1] = { through: [k + 1, k + 6, ((k + 1) % 5) + 1], closed: false };
  }
  return { ductile: 1, name, points, curves };
}

/** Two quadrangles with a bent curve between them: curve 7. */
export function twoLoops(name = "Two loops") {
  const points = { 1: [-1, -0.6, 0], 2: [0, -0.6, 0.1], 3: [1, -0.6, 0], 4: [1, 0.6, 0], 5: [0, 0.6, 0.1], 6: [-1, 0.6, 0], 7: [0, 0, 0.3] };
  const open = (...through) => ({ through, closed: false });
  const curves = { 1: open(1, 2), 2: open(2, 3), 3: open(3, 4), 4: open(4, 5), 5: open(5, 6), 6: open(6, 1), 7: open(2, 7, 5) };
  return { ductile: 1, name, points, curves };
}

/** A closed curve, round but for its heights, through the points 1 to 6. */
export function hexagon(name = "Hexagon") {
  const points = {};
  for (let k = 0; k < 6; k += 1) {
    const at = [Math.cos((Math.PI * k) / 3), Math.sin((Math.PI * k) / 3), k % 2 === 0 ? 0.2 : -0.2];
    points[k + 1] = at.map((x) => Number(x.toFixed(3)));
  }
  return { ductile: 1, name, points, curves: { 1: { through: [1, 2, 3, 4, 5, 6], closed: true } } };
}
