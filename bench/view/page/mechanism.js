// The mechanism of one motion as a handful of meshes, one for every layer, unit shape and colour role: a thousand bodies
// are drawn in as many calls as one. Few parts are instances of their shape, many are merged (merged.js).

import { BoxGeometry, BufferGeometry, Color, ConeGeometry, Curve, CylinderGeometry, DoubleSide, Float32BufferAttribute, Group,
  InstancedMesh, MeshLambertMaterial, SphereGeometry, TorusGeometry, TubeGeometry, Vector3 } from "three";
import { bodyParts, ellipsoid } from "./bodies.js";
import { add, ball, length, scale, segment } from "./geometry.js";
import { Merged } from "./merged.js";
import { groundParts, jointParts, lineParts } from "./symbols.js";

class Helix extends Curve {
  getPoint(s, target = new Vector3()) {
    const turns = 10, lead = 0.06, inner = (s - lead) / (1 - 2 * lead);
    if (inner <= 0 || inner >= 1) return target.set(0, 0, 12 * s);
    const rise = Math.min(1, 8 * Math.min(inner, 1 - inner)), angle = 2 * Math.PI * turns * inner;
    return target.set(rise * Math.cos(angle), rise * Math.sin(angle), 12 * s);
  }
}

// Unit shapes: along z from 0 to 1 with radius 1, or around the origin. Of many instances, fewer corners each.
function geometry(kind, many) {
  const sides = many ? 4 : 16;
  const upright = (g) => g.rotateX(Math.PI / 2).translate(0, 0, 0.5);
  switch (kind) {
    case "rod": return upright(new CylinderGeometry(1, 1, 1, sides, 1, many));
    case "cone": return upright(new ConeGeometry(1, 1, sides));
    case "ball": return new SphereGeometry(1, many ? 6 : 24, many ? 4 : 16);
    case "box": return new BoxGeometry(1, 1, 1);
    case "ring": return new TorusGeometry(1, 0.16, 8, 32);
    case "coil": return new TubeGeometry(new Helix(), many ? 120 : 280, 0.13, many ? 4 : 7).scale(1, 1, 1 / 12);
    default: {  // plate
      const g = new BufferGeometry();
      g.setAttribute("position", new Float32BufferAttribute([0, 0, 0, 1, 0, 0, 0, 1, 0], 3));
      g.setAttribute("normal", new Float32BufferAttribute([0, 0, 1, 0, 0, 1, 0, 0, 1], 3));
      return g;
    }
  }
}

export const MANY = 300;  // parts of a kind, or bodies, that are drawn with less care

export class Mechanism {
  // `look`: colour(body) and opacity; u: size of symbols; reach: size of the whole, m.
  constructor(data, motion, look, { up, u, reach }) {
    this.data = data;
    this.motion = motion;
    this.look = look;
    this.reach = reach;
    this.group = new Group();
    this.batches = new Map();
    data.bodies.forEach((body, b) => {
      for (const [kind, matrix, glass] of bodyParts(body, u)) this.#add("bodies", kind, "body", glass, { body: b, matrix, owner: b });
      this.#add("ellipsoids", "ball", "body", true, { body: b, matrix: ellipsoid(body, u), owner: b });
      this.#add("centres", "ball", "centre", false, { body: b, matrix: ball([0, 0, 0], 0.95 * u) });
      for (const k of [0, 1, 2]) {
        const axis = [0, 1, 2].map((n) => (n === k ? 6 * u : 0));
        this.#add("axes", "rod", "xyz"[k], false, { body: b, matrix: segment([0, 0, 0], axis, 0.28 * u) });
      }
    });
    for (const [body, kind, matrix, role] of jointParts(data, motion, up, u)) this.#add("joints", kind, role, false, { body, matrix });
    for (const [body, kind, matrix, role] of groundParts(data, up, u)) this.#add("ground", kind, role, false, { body, matrix });
    for (const line of data.symbols.lines)
      for (const [kind, radius, from, to, role] of lineParts(line, u)) this.#add("springs", kind, role, false, { line, radius, from, to });
    this.#addLoads(u);
    for (const batch of this.batches.values()) this.#build(batch);
  }

  #add(layer, kind, role, glass, part) {
    const key = [layer, kind, role, glass].join();
    if (!this.batches.has(key)) this.batches.set(key, { layer, kind, role, glass, parts: [] });
    this.batches.get(key).parts.push(part);
  }

  // Forces and torques are as long as they are large, the largest of their kind a fifth of the mechanism.
  #addLoads(u) {
    const first = this.motion.curveColumn(this.data.curves.length), most = { force: 0, torque: 0 };
    const loads = this.data.loads.map((load, k) => {
      const columns = [0, 1, 2].map((n) => this.motion.column(first + 3 * k + n));
      for (let f = 0; f < this.motion.frames; ++f)
        most[load.type] = Math.max(most[load.type], Math.hypot(columns[0][f], columns[1][f], columns[2][f]));
      return { ...load, column: first + 3 * k };
    });
    for (const load of loads) {
      const per = most[load.type] > 0 ? 0.2 * this.reach / most[load.type] : 0;
      const heads = load.type === "torque" ? [0, 3 * u] : [0];
      this.#add("loads", "rod", load.type, false, { load, per, radius: 0.5 * u, head: 0 });
      for (const back of heads) this.#add("loads", "cone", load.type, false, { load, per, radius: 1.5 * u, head: 3.2 * u, back });
    }
  }

  #build(batch) {
    const n = batch.parts.length;
    const material = new MeshLambertMaterial(batch.kind === "plate" ? { side: DoubleSide } : {});
    const opacity = (batch.glass ? 0.4 : 1) * this.look.opacity;
    if (opacity < 1) Object.assign(material, { transparent: true, opacity, depthWrite: !batch.glass });
    const many = n > MANY, shape = geometry(batch.kind, many);
    batch.mesh = many ? new Merged(shape, material, n) : new InstancedMesh(shape, material, n);
    batch.mesh.frustumCulled = false;
    if (batch.role === "body") {
      const colour = new Color();
      batch.parts.forEach((part, k) => batch.mesh.setColorAt(k, colour.set(this.look.colour(part.owner))));
    }
    this.group.add(batch.mesh);
  }

  // Layers and roles there is something of.
  has(layer) { return [...this.batches.values()].some((batch) => batch.layer === layer); }
  show(layer, visible) {
    for (const batch of this.batches.values()) if (batch.layer === layer) batch.mesh.visible = visible;
  }
  paint(colours) {
    for (const batch of this.batches.values()) if (batch.role !== "body") batch.mesh.material.color.set(colours[batch.role]);
  }

  // Puts everything where the motion, evaluated at `time`, has it.
  update(time) {
    for (const batch of this.batches.values()) {
      if (!batch.mesh.visible) continue;
      const mesh = batch.mesh, out = mesh.matrices ?? mesh.instanceMatrix.array;
      batch.parts.forEach((part, k) => {
        if (part.matrix) this.#place(part, out, 16 * k);
        else out.set(part.line ? this.#line(part) : this.#arrow(part, time), 16 * k);
      });
      if (mesh.matrices) mesh.commit();
      else mesh.instanceMatrix.needsUpdate = true;
    }
  }

  #place({ body, matrix: m }, out, o) {
    if (body < 0) {
      out.set(m, o);
      return;
    }
    const A = this.motion.A, a = 9 * body, r = this.motion.r;
    for (let c = 0; c < 16; c += 4) {
      for (let row = 0; row < 3; ++row)
        out[o + c + row] = A[a + 3 * row] * m[c] + A[a + 3 * row + 1] * m[c + 1] + A[a + 3 * row + 2] * m[c + 2] +
                           m[c + 3] * r[3 * body + row];
      out[o + c + 3] = m[c + 3];
    }
  }

  #line({ line, radius, from, to }) {
    const p = this.motion.point(line.i, line.s_i), q = this.motion.point(line.j, line.s_j);
    const along = (share) => add(scale(p, 1 - share), q, share);
    return segment(along(from), along(to), radius);
  }

  #arrow({ load, per, radius, head, back = 0 }, time) {
    const given = [0, 1, 2].map((n) => this.motion.value(load.column + n, time));
    const v = scale(load.frame === "body" ? this.motion.direction(load.body, given) : given, per);
    const from = this.motion.point(load.body, load.point), size = length(v);
    if (size < 1e-9 * this.reach) return new Float32Array(16);  // nothing
    const tip = add(from, v);
    if (head === 0) return segment(from, tip, Math.min(radius, size / 6));
    const shrink = Math.min(1, size / (2 * head));  // of a short arrow
    return segment(add(tip, v, -shrink * (head + back) / size), add(tip, v, -shrink * back / size), radius * shrink);
  }
}
