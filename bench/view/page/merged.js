// Many parts of one shape in a single geometry, its corners computed here for every picture. Renderers in software draw
// one instance of an InstancedMesh after the other, each at the cost of a call; the corners of a few thousand small parts
// cost less than that: a picture of 1000 bodies in SwiftShader takes 49 ms of the processors' time, 93 by instances (on
// 1084 by 556 pixels, which alone take 31).

import { BufferAttribute, BufferGeometry, DynamicDrawUsage, Mesh } from "three";

export class Merged extends Mesh {
  // `shape`: geometry of one part; n of them stand where `matrices`, 16 numbers each, say at commit().
  constructor(shape, material, n) {
    const at = shape.attributes.position, corners = at.count, index = shape.index?.array ?? [...Array(corners).keys()];
    const merged = new BufferGeometry(), indices = new Uint32Array(n * index.length);
    for (const name of ["position", "normal"])
      merged.setAttribute(name, new BufferAttribute(new Float32Array(3 * n * corners), 3).setUsage(DynamicDrawUsage));
    for (let k = 0; k < n; ++k)
      for (let m = 0; m < index.length; ++m) indices[k * index.length + m] = k * corners + index[m];
    merged.setIndex(new BufferAttribute(indices, 1));
    super(merged, material);
    this.count = n;
    this.corners = corners;
    this.points = at.array;
    this.normals = shape.attributes.normal.array;
    this.matrices = new Float32Array(16 * n);
  }

  setColorAt(k, colour) {
    const g = this.geometry;
    if (!g.attributes.color) {
      g.setAttribute("color", new BufferAttribute(new Float32Array(3 * this.count * this.corners), 3));
      this.material.vertexColors = true;
    }
    for (let m = 0; m < this.corners; ++m) colour.toArray(g.attributes.color.array, 3 * (k * this.corners + m));
  }

  // Normals go by the inverse transposed: along columns over the squares of their lengths, which are at right angles but
  // for plates, and theirs is one of the columns.
  commit() {
    const { position, normal } = this.geometry.attributes, x = position.array, n = normal.array, M = this.matrices;
    let o = 0;
    for (let k = 0; k < this.count; ++k) {
      const m = 16 * k;
      const [u, v, w] = [0, 4, 8].map((c) => 1 / (M[m + c] ** 2 + M[m + c + 1] ** 2 + M[m + c + 2] ** 2 || 1));
      for (let p = 0; p < 3 * this.corners; p += 3, o += 3) {
        const a = this.points[p], b = this.points[p + 1], c = this.points[p + 2];
        const d = u * this.normals[p], e = v * this.normals[p + 1], f = w * this.normals[p + 2];
        for (let row = 0; row < 3; ++row) {
          const p0 = M[m + row], p1 = M[m + 4 + row], p2 = M[m + 8 + row];
          x[o + row] = p0 * a + p1 * b + p2 * c + M[m + 12 + row];
          n[o + row] = p0 * d + p1 * e + p2 * f;
        }
      }
    }
    position.needsUpdate = normal.needsUpdate = true;
  }
}
