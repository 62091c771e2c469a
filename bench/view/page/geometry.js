// Small vectors, and the matrices of unit shapes (16 numbers by columns, as WebGL takes them).

export const add = (a, b, f = 1) => [a[0] + f * b[0], a[1] + f * b[1], a[2] + f * b[2]];
export const sub = (a, b) => add(a, b, -1);
export const scale = (a, f) => [f * a[0], f * a[1], f * a[2]];
export const dot = (a, b) => a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
export const cross = (a, b) => [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]];
export const length = (a) => Math.hypot(a[0], a[1], a[2]);
export const unit = (a) => { const l = length(a); return l > 0 ? scale(a, 1 / l) : [0, 0, 1]; };

// A direction normal to d, always the same for the same d.
export function normalTo(d) {
  const [x, y, z] = d.map(Math.abs);
  return unit(cross(d, x <= y && x <= z ? [1, 0, 0] : y <= z ? [0, 1, 0] : [0, 0, 1]));
}

// Columns x, y, z and the origin.
export const frame = (x, y, z, o) => [...x, 0, ...y, 0, ...z, 0, ...o, 1];

// What lies along z from 0 to 1 with radius 1 is laid from p to q.
export function segment(p, q, radius) {
  const d = sub(q, p), x = normalTo(d), y = cross(unit(d), x);
  return frame(scale(x, radius), scale(y, radius), d, p);
}
// The same, centred at p along a direction.
export const pin = (p, axis, half, radius) => segment(add(p, axis, -half), add(p, axis, half), radius);
export const ball = (p, radius) => frame([radius, 0, 0], [0, radius, 0], [0, 0, radius], p);
// A box with one pair of faces normal to an axis.
export function block(p, axis, along, across) {
  const z = unit(axis), x = normalTo(z), y = cross(z, x);
  return frame(scale(x, across), scale(y, across), scale(z, along), p);
}
// The unit triangle (0,0) (1,0) (0,1) on three points.
export function triangle(a, b, c) {
  const x = sub(b, a), y = sub(c, a);
  return frame(x, y, unit(cross(x, y)), a);
}

// Columns of the rotation of Euler parameters.
export function axesOf([e0, e1, e2, e3]) {
  return [
    [e0 * e0 + e1 * e1 - e2 * e2 - e3 * e3, 2 * (e1 * e2 + e0 * e3), 2 * (e1 * e3 - e0 * e2)],
    [2 * (e1 * e2 - e0 * e3), e0 * e0 - e1 * e1 + e2 * e2 - e3 * e3, 2 * (e2 * e3 + e0 * e1)],
    [2 * (e1 * e3 + e0 * e2), 2 * (e2 * e3 - e0 * e1), e0 * e0 - e1 * e1 - e2 * e2 + e3 * e3]];
}

// The convex hull, in order, of points in the plane with normal n; the points keep their third dimension.
export function hull(points, n) {
  const x = normalTo(n), y = cross(n, x);
  const flat = points.map((p) => ({ p, u: dot(p, x), v: dot(p, y) })).sort((a, b) => a.u - b.u || a.v - b.v);
  const turn = (o, a, b) => (a.u - o.u) * (b.v - o.v) - (a.v - o.v) * (b.u - o.u);
  const half = (list) => {
    const chain = [];
    for (const p of list) {
      while (chain.length > 1 && turn(chain[chain.length - 2], chain[chain.length - 1], p) <= 0) chain.pop();
      chain.push(p);
    }
    chain.pop();
    return chain;
  };
  return [...half(flat), ...half([...flat].reverse())].map((one) => one.p);
}
