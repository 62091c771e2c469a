// Joints by the symbols of mechanism drawings, all in the frames of the bodies they sit on:
//   revolute      a pin along its axis             cylindrical    a rod on body i through a sleeve on body j
//   spherical     a ball                           translational  a rail on body i, a block on body j
//   universal     a cross of two pins              fixed          a cube
// A joint to the ground stands on a small pedestal.

import { add, ball, block, dot, length, pin, segment, sub } from "./geometry.js";

// From where to where body j's point goes along body i's axis, from body i's point, over the motion.
function slide(joint, motion) {
  const every = Math.max(1, Math.floor(motion.frames / 200));
  let least = Infinity, most = -Infinity;
  for (let k = 0; k < motion.frames; k += every) {
    motion.evaluate(motion.t[k]);
    const d = sub(motion.point(joint.j, joint.s_j), motion.point(joint.i, joint.s_i));
    const x = dot(d, motion.direction(joint.i, joint.axis_i));
    least = Math.min(least, x);
    most = Math.max(most, x);
  }
  return [least, most];
}

const turned = ({ type, i, j, s_i, s_j, axis_i, axis_j }) =>
  ({ type, i: j, j: i, s_i: s_j, s_j: s_i, axis_i: axis_j, axis_j: axis_i });

// [body, kind, matrix, role] of a joint's parts.
function joint(given, motion, u) {
  const one = given.j < 0 ? turned(given) : given;  // what slides is not the ground
  const { i, j, s_i, s_j, axis_i, axis_j } = one;
  const rod = (radius) => {
    const [least, most] = slide(one, motion);
    return segment(add(s_i, axis_i, least - 5 * u), add(s_i, axis_i, most + 5 * u), radius);
  };
  switch (one.type) {
    case "revolute":
      return [[j, "rod", pin(s_j, axis_j, 2.6 * u, 1.1 * u), "joint"]];
    case "universal":
      return [[i, "rod", pin(s_i, axis_i, 2.4 * u, 0.7 * u), "joint"], [j, "rod", pin(s_j, axis_j, 2.4 * u, 0.7 * u), "joint"]];
    case "cylindrical":
      return [[i, "rod", rod(0.5 * u), "joint"], [j, "rod", pin(s_j, axis_j, 2.2 * u, 1.3 * u), "joint"]];
    case "translational":
      return [[i, "rod", rod(0.5 * u), "joint"], [j, "box", block(s_j, axis_j, 4.4 * u, 2.6 * u), "joint"]];
    case "fixed":
      return [[j, "box", block(s_j, [0, 0, 1], 2.2 * u, 2.2 * u), "joint"]];
    default:  // spherical
      return [[j, "ball", ball(s_j, 1.5 * u), "joint"]];
  }
}

// A pedestal under a point of the ground; one only where several joints share the point.
function pedestals(joints, up, u) {
  const points = [];
  for (const one of joints) {
    if (one.type === "translational" || one.type === "cylindrical") continue;
    for (const [body, s] of [[one.i, one.s_i], [one.j, one.s_j]])
      if (body < 0 && points.every((p) => length(sub(p, s)) > 1e-9)) points.push(s);
  }
  return points.flatMap((p) => [
    [-1, "cone", segment(add(p, up, -4 * u), p, 2.2 * u), "ground"],
    [-1, "rod", segment(add(p, up, -4.6 * u), add(p, up, -4 * u), 3 * u), "ground"]]);
}

// Where what turns about an axis is drawn: at a joint of the same bodies, else at the moving body's centre of mass.
function turn(one, joints, u) {
  const at = joints.find((k) => (k.i === one.i && k.j === one.j) || (k.i === one.j && k.j === one.i));
  const role = one.type === "angle" ? "driver" : "spring";
  const onI = at && (at.i === one.i ? at.s_i : at.s_j);
  if (at) return [one.i, "ring", block(onI, one.axis_i, 3.4 * u, 3.4 * u), role];
  return [one.j >= 0 ? one.j : one.i, "ring", block([0, 0, 0], one.axis_i, 3.4 * u, 3.4 * u), role];
}

export function jointParts(data, motion, up, u) {
  const { joints, turns } = data.symbols;
  return [...joints.flatMap((one) => joint(one, motion, u)), ...turns.map((one) => turn(one, joints, u))];
}
export const groundParts = (data, up, u) => pedestals(data.symbols.joints, up, u);

// Lines between two bodies: [kind, radius, from, to, role] with from and to as shares of the way from i to j.
export function lineParts(line, u) {
  switch (line.type) {
    case "spring":
      return [["coil", 1.8 * u, 0, 1, "spring"]];
    case "distance":  // a telescope
      return [["rod", 0.55 * u, 0, 1, "driver"], ["rod", 0.95 * u, 0, 0.45, "driver"]];
    default:  // D: a massless rod
      return [["rod", 0.25 * u, 0, 1, "joint"]];
  }
}
