// The stage: renderer, light, camera and its controls, the ground's grid and the global axes. Draws when something has
// changed, not all the time.

import { BufferGeometry, CanvasTexture, Color, DirectionalLight, Float32BufferAttribute, HemisphereLight, LineBasicMaterial,
  LineSegments, PerspectiveCamera, Scene, Sprite, SpriteMaterial, Vector3, WebGLRenderer } from "three";
import { OrbitControls } from "three/examples/jsm/controls/OrbitControls.js";
import { add, cross, dot, normalTo, scale, unit } from "./geometry.js";

const THEMES = {
  light: { page: "#ffffff", grid: "#d3d8de", joint: "#4a5158", ground: "#8f979f", centre: "#111417", spring: "#3f7d3a", driver: "#a3387a",
    force: "#c22f2f", torque: "#7a3fb5", x: "#cc3333", y: "#2f8f2f", z: "#2f5fd0", letters: "#2a3036" },
  dark: { page: "#14171a", grid: "#343b43", joint: "#b9c1c9", ground: "#7d868f", centre: "#f4f6f8", spring: "#8fd184", driver: "#ee8cc8",
    force: "#ff7d70", torque: "#c8a0ff", x: "#ff7a7a", y: "#7fdc7f", z: "#8db4ff", letters: "#dde2e7" },
};

// 1, 2 or 5 times a power of ten, at least x.
export function roundUp(x) {
  const power = 10 ** Math.floor(Math.log10(x));
  return [1, 2, 5, 10].map((f) => f * power).find((f) => f >= x * 0.999);
}

function letter(text) {
  const canvas = document.createElement("canvas");
  canvas.width = canvas.height = 64;
  const draw = canvas.getContext("2d");
  draw.font = "bold 48px sans-serif";
  draw.textAlign = "center";
  draw.textBaseline = "middle";
  draw.fillStyle = "#fff";
  draw.fillText(text, 32, 34);
  return new Sprite(new SpriteMaterial({ map: new CanvasTexture(canvas), depthTest: false, transparent: true }));
}

export class Stage {
  // `bounds`: {least, most} of all that moves; `up`: against gravity; `smooth`: edges without steps, for more work.
  constructor(canvas, bounds, up, planar, smooth) {
    this.canvas = canvas;
    this.up = up;
    this.centre = scale(add(bounds.least, bounds.most), 0.5);
    this.radius = Math.max(bounds.size / 2, 1e-9);
    this.renderer = new WebGLRenderer({ canvas, antialias: smooth, alpha: false });
    this.renderer.setPixelRatio(smooth ? Math.min(window.devicePixelRatio, 2) : 1);
    this.scene = new Scene();
    this.scene.add(new HemisphereLight(0xffffff, 0x8a8f96, 1.9));
    this.camera = new PerspectiveCamera(30, 1, this.radius / 100, this.radius * 100);
    this.camera.up.set(...up);
    const light = new DirectionalLight(0xffffff, 1.6);
    light.position.set(0.5, 1, 1);
    this.camera.add(light);
    this.scene.add(this.camera);
    this.controls = new OrbitControls(this.camera, canvas);
    this.controls.addEventListener("change", () => this.invalidate());
    this.home = planar ?? unit(add(add(scale(normalTo(up), 0.9), cross(up, normalTo(up)), 0.75), up, 0.55));
    this.#grid(bounds);
    this.#axes();
    this.frames = 0;  // drawn so far
    new ResizeObserver(() => this.#resize()).observe(canvas.parentElement);
    this.#resize();
    this.look(this.home);
  }

  #grid({ least, most }) {
    const up = this.up, x = normalTo(up), y = cross(up, x);
    const lowest = Math.min(...[0, 1, 2, 3, 4, 5, 6, 7].map((k) => dot([0, 1, 2].map((n) => (k >> n & 1 ? most : least)[n]), up)));
    this.spacing = roundUp(this.radius / 4);
    const lines = 8, half = lines * this.spacing / 2;
    const at = (d) => Math.round(dot(this.centre, d) / this.spacing) * this.spacing;
    const origin = add(add(scale(x, at(x)), y, at(y)), up, lowest - 0.12 * this.radius);
    const corners = [];
    for (let k = 0; k <= lines; ++k)
      for (const [a, b] of [[x, y], [y, x]])
        for (const f of [-half, half]) corners.push(...add(add(origin, a, -half + k * this.spacing), b, f));
    const geometry = new BufferGeometry().setAttribute("position", new Float32BufferAttribute(corners, 3));
    this.grid = new LineSegments(geometry, new LineBasicMaterial());
    this.scene.add(this.grid);
  }

  #axes() {
    const size = 0.22 * this.radius;
    this.axes = ["x", "y", "z"].map((name, k) => {
      const end = [0, 1, 2].map((n) => (n === k ? size : 0));
      const geometry = new BufferGeometry().setAttribute("position", new Float32BufferAttribute([0, 0, 0, ...end], 3));
      const line = new LineSegments(geometry, new LineBasicMaterial()), text = letter(name);
      text.position.set(...scale(end, 1.18));
      text.scale.setScalar(0.09 * this.radius);
      this.scene.add(line, text);
      return { name, line, text };
    });
  }

  show(visible) {
    for (const { line, text } of this.axes) line.visible = text.visible = visible;
    this.grid.visible = visible;
  }

  // The colours of the page's scheme, for what is drawn here and by others.
  theme(dark) {
    const colours = dark ? THEMES.dark : THEMES.light;
    this.scene.background = new Color(colours.page);
    this.grid.material.color = new Color(colours.grid);
    for (const { name, line, text } of this.axes) {
      line.material.color = new Color(colours[name]);
      text.material.color = new Color(colours[name]);
    }
    this.invalidate();
    return colours;
  }

  // Looks at the whole from a direction.
  look(direction) {
    const aspect = Math.min(1, this.camera.aspect), half = this.camera.fov * Math.PI / 360;
    const distance = 1.12 * this.radius / Math.sin(Math.atan(Math.tan(half) * aspect));
    this.controls.target.set(...this.centre);
    // Straight down or up, the side that stays at the bottom is the home view's.
    const steep = Math.abs(dot(unit(direction), this.up)) > 0.999;
    const from = steep ? unit(add(unit(direction), this.#level(this.home), 1e-3)) : direction;
    this.camera.position.set(...add(this.centre, unit(from), distance));
    this.controls.update();
    this.invalidate();
  }
  #level(d) {
    const flat = add(d, this.up, -dot(d, this.up));
    return Math.hypot(...flat) > 1e-6 ? unit(flat) : normalTo(this.up);
  }

  // By keyboard: angles in rad, shares of the distance, a factor.
  turn(around, over) {
    const offset = this.camera.position.clone().sub(this.controls.target), up = new Vector3(...this.up);
    offset.applyAxisAngle(up, around);
    const side = new Vector3().crossVectors(up, offset).normalize(), angle = offset.angleTo(up);
    offset.applyAxisAngle(side, Math.min(Math.PI - 0.02, Math.max(0.02, angle + over)) - angle);
    this.camera.position.copy(this.controls.target).add(offset);
    this.controls.update();
    this.invalidate();
  }
  move(right, above) {
    const distance = this.camera.position.distanceTo(this.controls.target);
    const x = new Vector3().setFromMatrixColumn(this.camera.matrix, 0), y = new Vector3().setFromMatrixColumn(this.camera.matrix, 1);
    const shift = x.multiplyScalar(right * distance).add(y.multiplyScalar(above * distance));
    this.camera.position.add(shift);
    this.controls.target.add(shift);
    this.controls.update();
    this.invalidate();
  }
  zoom(factor) {
    const offset = this.camera.position.clone().sub(this.controls.target).multiplyScalar(factor);
    this.camera.position.copy(this.controls.target).add(offset);
    this.controls.update();
    this.invalidate();
  }

  #resize() {
    const { clientWidth: width, clientHeight: height } = this.canvas.parentElement;
    if (!width || !height) return;
    this.renderer.setSize(width, height, false);
    const before = Math.min(1, this.camera.aspect);
    this.camera.aspect = width / height;
    this.camera.updateProjectionMatrix();
    if (this.frames > 0) this.zoom(before / Math.min(1, this.camera.aspect));
    this.invalidate();
  }

  invalidate() {
    if (this.due) return;
    this.due = requestAnimationFrame(() => {
      this.due = 0;
      this.draw();
    });
  }
  copyTo(canvas) {
    this.draw();
    canvas.width = this.canvas.width;
    canvas.height = this.canvas.height;
    canvas.getContext("2d").drawImage(this.canvas, 0, 0);
  }
  draw() {
    this.renderer.render(this.scene, this.camera);
    ++this.frames;
  }
}
