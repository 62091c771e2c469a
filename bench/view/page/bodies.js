// What a body looks like: its shape where the scene gives one, else rods and plates between the points where
// constraints and forces attach and its centre of mass, else the ellipsoid of its mass and inertia.

import { add, axesOf, ball, cross, dot, frame, hull, length, pin, scale, segment, sub, triangle, unit } from "./geometry.js";

const CENTRE = [0, 0, 0];

// The points that make up a body, its centre of mass among them.
function outline(body) {
  const points = [CENTRE];
  for (const p of body.points) if (points.every((q) => length(sub(p, q)) > 0)) points.push(p);
  return points;
}

// How far a body reaches from end to end, m.
export function extent(body) {
  const points = outline(body);
  let most = 0;
  for (const p of points) for (const q of points) most = Math.max(most, length(sub(p, q)));
  const s = body.shape;
  if (s?.type === "polyline") for (const p of s.points) most = Math.max(most, 2 * length(p));
  else if (s) most = Math.max(most, length(s.size), 2 * s.radius, s.length);
  return most > 0 ? most : 2 * Math.max(...body.ellipsoid.radii);
}

// Corners that the picture has to hold, in the body's frame.
export function corners(body) {
  const points = outline(body), s = body.shape;
  if (s) {
    const reach = s.type === "polyline" ? 0 : Math.max(length(s.size) / 2, Math.hypot(s.radius, s.length / 2));
    for (const k of [0, 1, 2]) for (const f of [-reach, reach]) points.push(s.at.map((x, n) => x + (n === k ? f : 0)));
    points.push(...s.points);
  }
  if (points.length === 1) for (const k of [0, 1, 2]) for (const f of [-1, 1]) points.push([0, 1, 2].map((n) => (n === k ? f * body.ellipsoid.radii[k] : 0)));
  return points;
}

function shaped(s, u) {
  const axis = unit(s.axis), half = s.length / 2;
  switch (s.type) {
    case "box":
      return [["box", frame([s.size[0], 0, 0], [0, s.size[1], 0], [0, 0, s.size[2]], s.at)]];
    case "sphere":
      return [["ball", ball(s.at, s.radius)]];
    case "cylinder":
      return [["rod", pin(s.at, axis, half, s.radius)]];
    case "capsule":
      return [["rod", pin(s.at, axis, half, s.radius)], ...[-half, half].map((f) => ["ball", ball(add(s.at, axis, f), s.radius)])];
    default:  // polyline
      return s.points.slice(1).map((p, k) => ["rod", segment(s.points[k], p, 0.5 * u)]);
  }
}

export function ellipsoid(body, u) {
  const axes = axesOf(body.ellipsoid.parameters);
  const radii = body.ellipsoid.radii.map((r) => Math.max(r, 0.2 * u));
  return frame(...axes.map((a, k) => scale(a, radii[k])), CENTRE);
}

// [kind, matrix in the body's frame, glass] of the body's parts; u is the size of symbols, m.
export function bodyParts(body, u) {
  if (body.shape) return shaped(body.shape, u);
  const points = outline(body);
  if (points.length === 1) return [["ball", ellipsoid(body, u), true]];  // others may be inside
  const far = points.reduce((a, b) => (length(b) > length(a) ? b : a));
  const offLine = (p) => length(cross(p, unit(far)));
  const aside = points.reduce((a, b) => (offLine(b) > offLine(a) ? b : a));
  if (offLine(aside) < 1e-3 * length(far)) {  // all on one line
    const along = points.map((p) => [dot(p, unit(far)), p]).sort((a, b) => a[0] - b[0]).map(([, p]) => p);
    return [["rod", segment(along[0], along[along.length - 1], 0.7 * u)]];
  }
  const n = unit(cross(far, aside)), ring = hull(points, n);
  const parts = ring.map((p, k) => ["rod", segment(p, ring[(k + 1) % ring.length], 0.45 * u)]);
  for (let k = 2; k < ring.length; ++k) parts.push(["plate", triangle(ring[0], ring[k - 1], ring[k]), true]);
  const middle = ring.reduce((sum, p) => add(sum, p, 1 / ring.length), CENTRE);
  for (const p of points) {  // what stands out of the plate
    if (!ring.includes(p) && Math.abs(dot(sub(p, ring[0]), n)) > 0.02 * length(far)) parts.push(["rod", segment(middle, p, 0.45 * u)]);
  }
  return parts;
}

export { CENTRE };
