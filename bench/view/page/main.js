// Puts the page together: data, mechanisms on the stage, time, plots, keys. Text from the scene is only ever set as
// text, never as markup.

import { corners, extent } from "./bodies.js";
import { dot, length, scale, sub, unit } from "./geometry.js";
import { listen, VIEWS } from "./keys.js";
import { MANY, Mechanism } from "./mechanism.js";
import { Motion } from "./motion.js";
import { Plots, number } from "./plots.js";
import { Stage } from "./stage.js";
import { points, trace } from "./traces.js";
import { Transport } from "./transport.js";

const PALETTE = ["#4e79a7", "#f28e2b", "#59a14f", "#e15759", "#76b7b2", "#b07aa1", "#d4b13f", "#9c755f", "#f08fa0", "#8a9199"];
const OVERLAY = ["#0a78bd", "#e0701a"];
const FEW = 12;  // bodies whose axes are shown from the start

const LAYERS = [["bodies", "bodies", () => true], ["joints", "joints", () => true], ["springs", "springs, distances", () => true],
  ["loads", "forces and torques", () => true], ["axes", "axes of the bodies", (n) => n <= FEW],
  ["centres", "centres of mass", (n) => n <= 4 * FEW], ["ellipsoids", "ellipsoids of inertia", () => false],
  ["ground", "ground and global axes", () => true]];

const by = (id) => document.getElementById(id);
function element(tag, text, properties = {}) {
  const made = Object.assign(document.createElement(tag), properties);
  if (text !== undefined) made.textContent = text;
  return made;
}

// What all motions need room for, global.
function boundsOf(data, motions) {
  const least = [Infinity, Infinity, Infinity], most = [-Infinity, -Infinity, -Infinity];
  const hold = (p) => p.forEach((x, k) => {
    least[k] = Math.min(least[k], x);
    most[k] = Math.max(most[k], x);
  });
  const outlines = data.bodies.map(corners);
  for (const motion of motions) {
    const every = Math.max(1, Math.floor(motion.frames / Math.max(20, Math.min(200, 40000 / data.bodies.length))));
    for (let k = 0; k < motion.frames; k += every) {
      motion.evaluate(motion.t[k]);
      outlines.forEach((outline, b) => outline.forEach((s) => hold(motion.point(b, s))));
    }
  }
  const { joints, lines } = data.symbols;
  for (const one of [...joints, ...lines]) {
    if (one.i < 0) hold(one.s_i);
    if (one.j < 0) hold(one.s_j);
  }
  return { least, most, size: length(sub(most, least)) || 1 };
}

// The direction a plane mechanism is looked at from: along the axis it has no extent in.
function planeView({ least, most, size }, up) {
  const flat = [0, 1, 2].filter((k) => most[k] - least[k] < 0.03 * size);
  if (flat.length !== 1) return null;
  const d = [0, 1, 2].map((k) => (k === flat[0] ? 1 : 0));
  if (Math.abs(dot(d, up)) > 0.1) return null;
  const right = [0, 1, 2].map((k) => up[(k + 1) % 3] * d[(k + 2) % 3] - up[(k + 2) % 3] * d[(k + 1) % 3]);
  return right.reduce((a, b) => a + b) >= 0 ? d : scale(d, -1);
}

function upOf(data, bounds) {
  if (length(data.gravity) > 0) return unit(scale(data.gravity, -1));
  return bounds.most[2] - bounds.least[2] < 0.03 * bounds.size ? [0, 1, 0] : [0, 0, 1];  // a drawing in the plane of x and y
}

function start() {
  const data = JSON.parse(by("data").textContent);
  const motions = data.motions.map((packed) => new Motion(packed, data));
  const two = motions.length > 1;
  const bounds = boundsOf(data, motions), up = upOf(data, bounds);
  const extents = data.bodies.map(extent).sort((a, b) => a - b);
  const usual = 0.03 * extents[extents.length >> 1];
  const u = Math.min(0.02 * bounds.size, Math.max(0.003 * bounds.size, usual));
  const colour = (motion) => (two ? () => OVERLAY[motion] : (b) => PALETTE[b % PALETTE.length]);

  const stage = new Stage(by("canvas"), bounds, up, planeView(bounds, up), data.bodies.length <= MANY);
  const mechanisms = motions.map((motion, k) => new Mechanism(data, motion, { colour: colour(k), opacity: k > 0 ? 0.6 : 1 }, { up, u, reach: bounds.size }));
  for (const mechanism of mechanisms) stage.scene.add(mechanism.group);

  const show = (time) => {
    motions.forEach((motion, k) => {
      motion.evaluate(time);
      mechanisms[k].update(time);
    });
    plots?.mark(time, transport.playing);
    stage.invalidate();
  };
  let plots = null;
  const transport = new Transport(motions, show);

  // Header.
  document.title = data.name ? `${data.name}: motion` : "Motion";
  by("name").textContent = data.name || "Motion";
  by("about").textContent = data.about;
  motions.forEach((motion, k) => {
    const item = element("li");
    if (two) item.append(element("span", "", { className: "chip", style: `background:${OVERLAY[k]}` }), " ");
    item.append(`${motion.label}, ${motion.frames} frames to ${number(motion.end)} s`);
    by("motions").append(item);
  });
  by("message").textContent = motions.filter((motion) => motion.message).map((motion) => `Incomplete: ${motion.message}`).join(" ");
  by("scale").textContent = `grid ${number(stage.spacing)} m`;

  // Views and layers.
  for (const [name, direction] of VIEWS) {
    const button = element("button", name, { type: "button" });
    button.setAttribute("aria-label", `View from ${name}`);
    button.addEventListener("click", () => stage.look(direction));
    by("views").append(button);
  }
  const reset = element("button", "reset", { type: "button" });
  reset.style.gridColumn = "span 2";
  reset.addEventListener("click", () => stage.look(stage.home));
  by("views").append(reset);
  const many = data.bodies.length;
  for (const [layer, name, first] of LAYERS) {
    if (layer !== "ground" && !mechanisms[0].has(layer)) continue;
    const box = element("input", undefined, { type: "checkbox", checked: first(many) }), label = element("label");
    const apply = () => {
      for (const mechanism of mechanisms) mechanism.show(layer, box.checked);
      if (layer === "ground") stage.show(box.checked);
      show(transport.now);
    };
    box.addEventListener("change", apply);
    label.append(box, ` ${name}`);
    by("layers").append(label);
    apply();
  }
  data.bodies.forEach((body, b) => {
    const item = element("li");
    if (!two) item.append(element("span", "", { className: "chip", style: `background:${PALETTE[b % PALETTE.length]}` }));
    item.append(element("span", body.name));
    by("bodies").append(item);
  });

  // Traces.
  const traceable = points(data);
  traceable.forEach((point, k) => by("point").add(new Option(point.name, k)));
  by("trace").addEventListener("click", () => {
    const point = traceable[by("point").value];
    const lines = motions.map((motion, k) => trace(point, motion, colour(k)(point.body)));
    stage.scene.add(...lines);
    const item = element("li", point.name), remove = element("button", "Remove", { type: "button" });
    remove.setAttribute("aria-label", `Remove the trace of ${point.name}`);
    remove.addEventListener("click", () => {
      stage.scene.remove(...lines);
      item.remove();
      by("point").focus();
      stage.invalidate();
    });
    item.append(remove);
    by("traces").append(item);
    show(transport.now);
  });

  plots = new Plots(by("plots"), data, motions, (time) => {
    transport.pause();
    transport.seek(time);
  });

  const scheme = matchMedia("screen and (prefers-color-scheme: dark)");
  const paint = (dark) => {
    const colours = stage.theme(dark);
    for (const mechanism of mechanisms) mechanism.paint(colours);
    plots.redraw();
  };
  scheme.addEventListener("change", () => paint(scheme.matches));
  paint(scheme.matches);
  // On paper stands a copy, in its colours: what WebGL has drawn is gone by then.
  addEventListener("beforeprint", () => {
    paint(false);
    stage.copyTo(by("printed"));
  });
  addEventListener("afterprint", () => paint(scheme.matches));

  const help = () => by("keys").showModal();
  by("help").addEventListener("click", help);
  listen({ transport, stage, help });
  transport.seek(transport.start);

  // For programs that look at the page: what it shows, to be read only.
  window.poinsot = Object.freeze({
    get time() { return transport.now; },
    get start() { return transport.start; },
    get end() { return transport.end; },
    get playing() { return transport.playing; },
    get drawn() { return stage.frames; },
    get bodies() { return data.bodies.map((body) => body.name); },
    pose(name, motion = 0) {
      const b = data.bodies.findIndex((body) => body.name === name), m = motions[motion];
      if (b < 0 || !m) return null;
      return { position: [...m.r.subarray(3 * b, 3 * b + 3)], orientation: [...m.p.subarray(4 * b, 4 * b + 4)] };
    },
  });
}

try {
  start();
} catch (error) {
  by("message").textContent = `The motion cannot be shown: ${error.message}`;
  throw error;
}
