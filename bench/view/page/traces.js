// Paths of chosen points over the whole motion.

import { BufferGeometry, Float32BufferAttribute, Line, LineBasicMaterial } from "three";

const MOST = 4000;  // points of a line

// "bar: centre of mass", "bar: point 1 (revolute1)": every point that can be traced.
export function points(data) {
  const { joints, lines } = data.symbols, same = (a, b) => a.every((x, k) => Math.abs(x - b[k]) < 1e-9);
  return data.bodies.flatMap((body, b) => [
    { body: b, s: [0, 0, 0], name: `${body.name}: centre of mass` },
    ...body.points.filter((s) => !same(s, [0, 0, 0])).map((s, k) => {
      const at = [...joints, ...lines].filter((one) => (one.i === b && same(one.s_i, s)) || (one.j === b && same(one.s_j, s)));
      return { body: b, s, name: `${body.name}: ${at.length > 0 ? at[0].name : `point ${k + 1}`}` };
    })]);
}

export function trace(point, motion, colour) {
  const every = Math.max(1, Math.ceil(motion.frames / MOST)), positions = [];
  for (let k = 0; k < motion.frames; k += every) {
    motion.evaluate(motion.t[k]);
    positions.push(...motion.point(point.body, point.s));
  }
  const geometry = new BufferGeometry().setAttribute("position", new Float32BufferAttribute(positions, 3));
  const line = new Line(geometry, new LineBasicMaterial({ color: colour }));
  line.frustumCulled = false;
  return line;
}
