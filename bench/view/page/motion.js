// A motion as the page is given it: packed columns, unpacked as views of one buffer, and poses between the frames.

function bytes(text) {
  const characters = atob(text), result = new Uint8Array(characters.length);
  for (let k = 0; k < result.length; ++k) result[k] = characters.charCodeAt(k);
  return result.buffer;
}
export const doubles = (text) => new Float64Array(bytes(text));
export const floats = (text) => new Float32Array(bytes(text));

const POSE = 7;  // x y z e0 e1 e2 e3

export class Motion {
  constructor(packed, data) {
    this.label = packed.label;
    this.message = packed.message;
    this.t = doubles(packed.t);
    this.centres = doubles(packed.centres);
    this.columns = floats(packed.columns);
    this.perBody = data.body_columns.length;
    this.bodies = data.bodies.length;
    // What was evaluated last, by body: position, Euler parameters, rotation matrix by rows.
    this.r = new Float64Array(3 * this.bodies);
    this.p = new Float64Array(4 * this.bodies);
    this.A = new Float64Array(9 * this.bodies);
    this.evaluate(this.start);
  }

  get frames() { return this.t.length; }
  get start() { return this.t[0]; }
  get end() { return this.t[this.t.length - 1]; }

  column(k) { return this.columns.subarray(k * this.frames, (k + 1) * this.frames); }
  // Columns of a body, of the mechanism's curves, of a load (three).
  bodyColumn(body, k) { return body * this.perBody + k; }
  curveColumn(k) { return this.bodies * this.perBody + k; }

  // The frame at or before a time, and how far it is to the next, from 0 to 1.
  locate(time) {
    let low = 0, high = this.frames - 1;
    while (low < high) {
      const middle = (low + high + 1) >> 1;
      if (this.t[middle] <= time) low = middle; else high = middle - 1;
    }
    const next = Math.min(low + 1, this.frames - 1);
    const share = next > low ? Math.min(1, Math.max(0, (time - this.t[low]) / (this.t[next] - this.t[low]))) : 0;
    return { frame: low, next, share };
  }

  value(column, time) {
    const { frame, next, share } = this.locate(time), offset = column * this.frames;
    const a = this.columns[offset + frame], b = this.columns[offset + next];
    return a + share * (b - a);
  }

  // Poses at a time: positions between frames on straight lines, orientations on the shorter great arc of SO(3).
  evaluate(time) {
    const { frame, next, share } = this.locate(time), n = this.frames, c = this.columns;
    for (let body = 0; body < this.bodies; ++body) {
      const first = body * this.perBody * n;
      for (let k = 0; k < 3; ++k) {
        const a = c[first + k * n + frame], b = c[first + k * n + next];
        this.r[3 * body + k] = this.centres[3 * body + k] + a + share * (b - a);
      }
      let cosine = 0;
      for (let k = 3; k < POSE; ++k) cosine += c[first + k * n + frame] * c[first + k * n + next];
      const sign = cosine < 0 ? -1 : 1, half = Math.acos(Math.min(1, Math.abs(cosine)));
      const small = half < 1e-4;
      const wa = small ? 1 - share : Math.sin((1 - share) * half) / Math.sin(half);
      const wb = sign * (small ? share : Math.sin(share * half) / Math.sin(half));
      let norm = 0;
      for (let k = 0; k < 4; ++k) {
        const e = wa * c[first + (3 + k) * n + frame] + wb * c[first + (3 + k) * n + next];
        this.p[4 * body + k] = e;
        norm += e * e;
      }
      norm = (this.p[4 * body] < 0 ? -1 : 1) / Math.sqrt(norm);
      for (let k = 0; k < 4; ++k) this.p[4 * body + k] *= norm;
      this.#rotation(body);
    }
  }

  #rotation(body) {
    const [e0, e1, e2, e3] = this.p.subarray(4 * body, 4 * body + 4), A = this.A, o = 9 * body;
    A[o] = e0 * e0 + e1 * e1 - e2 * e2 - e3 * e3; A[o + 1] = 2 * (e1 * e2 - e0 * e3); A[o + 2] = 2 * (e1 * e3 + e0 * e2);
    A[o + 3] = 2 * (e1 * e2 + e0 * e3); A[o + 4] = e0 * e0 - e1 * e1 + e2 * e2 - e3 * e3; A[o + 5] = 2 * (e2 * e3 - e0 * e1);
    A[o + 6] = 2 * (e1 * e3 - e0 * e2); A[o + 7] = 2 * (e2 * e3 + e0 * e1); A[o + 8] = e0 * e0 - e1 * e1 - e2 * e2 + e3 * e3;
  }

  // Where a direction and a point of a body (−1: the ground) are now, global.
  direction(body, a) {
    if (body < 0) return [...a];
    const A = this.A, o = 9 * body;
    return [0, 3, 6].map((row) => A[o + row] * a[0] + A[o + row + 1] * a[1] + A[o + row + 2] * a[2]);
  }
  point(body, s) {
    const x = this.direction(body, s);
    if (body >= 0) for (let k = 0; k < 3; ++k) x[k] += this.r[3 * body + k];
    return x;
  }
}
