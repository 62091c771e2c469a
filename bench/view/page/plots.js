// Curves over time: energy, violation of the constraints, any column of any body, loads, and where two motions part.
// A plot is dragged over to move in time; the value at the time shown stands under its title.

import uPlot from "uplot";
import { floats } from "./motion.js";

const UNITS = { x: "m", v: "m/s", w: "rad/s", a: "m/s²", al: "rad/s²", e: "" };

function unitOf(column) {
  if (/^al[xyz]$/.test(column)) return UNITS.al;
  if (/^[vwa][xyz]$/.test(column)) return UNITS[column[0]];
  return /^e\d$/.test(column) ? UNITS.e : UNITS.x;
}

export function number(x, digits = 6) {
  if (x === null || x === undefined || !Number.isFinite(x)) return "–";
  const size = Math.abs(x);
  return size !== 0 && (size < 1e-3 || size >= 1e6) ? x.toExponential(Math.max(0, digits - 2)) : String(Number(x.toPrecision(digits)));
}
function tick(x) {
  if (x === null) return "";
  const size = Math.abs(x);
  return size !== 0 && (size < 1e-3 || size >= 1e5) ? x.toExponential(2).replace(/\.?0+e/, "e") : String(Number(x.toPrecision(6)));
}

// The decades of logarithms, without the lowest hundredth of them: where a curve touches 0 it falls without end.
function decades(columns) {
  const all = columns.flatMap((column) => Array.from(column).filter((x) => x !== null && x !== undefined)).sort((a, b) => a - b);
  if (all.length === 0) return [-16, 0];
  const least = Math.floor(all[Math.floor(all.length / 100)]), most = Math.ceil(all.at(-1));
  return [least, Math.max(most, least + 1)];
}

// What can be plotted: sources by name, each with quantities {name, unit, curves: [{t, values, motion}]}.
export function sources(data, motions) {
  const column = (of) => motions.map((m, k) => ({ t: m.t, values: () => m.column(of(m)), motion: k }));
  const centred = (body, k) => motions.map((m, n) => ({
    t: m.t, motion: n, values: () => Float64Array.from(m.column(m.bodyColumn(body, k)), (x) => x + m.centres[3 * body + k]) }));
  const all = [{ name: "mechanism", quantities: data.curves.map((curve, k) => ({ ...curve, curves: column((m) => m.curveColumn(k)) })) }];
  if (data.apart) {
    const values = floats(data.apart), n = values.length / 3, t = motions[0].t.slice(0, n);
    const part = (k) => [{ t, motion: null, values: () => values.subarray(k * n, (k + 1) * n) }];
    all.unshift({ name: "how far the two are apart", quantities: [
      { name: "largest distance of a body", unit: "m", curves: part(0) }, { name: "largest angle of a body", unit: "rad", curves: part(1) }] });
  }
  data.bodies.forEach((body, b) => all.push({ name: body.name, quantities: data.body_columns.map((name, k) => ({
    name, unit: unitOf(name), curves: k < 3 ? centred(b, k) : column((m) => m.bodyColumn(b, k)) })) }));
  data.loads.forEach((load, k) => all.push({ name: load.name, quantities: ["x", "y", "z"].map((name, n) => ({
    name, unit: load.unit, curves: column((m) => m.curveColumn(data.curves.length) + 3 * k + n) })) }));
  return all;
}

function selectOf(label, names) {
  const select = document.createElement("select");
  select.setAttribute("aria-label", label);
  names.forEach((name, k) => select.add(new Option(name, k)));
  return select;
}

const DECADES = [1, 2, 5, 10, 20, 50, 100, 200];  // from tick to tick of logarithms

class Plot {
  constructor(board, source, quantity, logarithmic) {
    this.board = board;
    this.root = document.createElement("div");
    this.root.className = "plot";
    const row = document.createElement("div");
    row.className = "row";
    this.source = selectOf("What is plotted", board.sources.map((s) => s.name));
    this.source.value = source;
    this.quantity = selectOf("Quantity", []);
    this.log = document.createElement("input");
    this.log.type = "checkbox";
    this.log.checked = logarithmic;
    const log = document.createElement("label");
    log.append(this.log, " log");
    const remove = document.createElement("button");
    remove.type = "button";
    remove.textContent = "×";
    remove.title = "Remove this plot";
    remove.setAttribute("aria-label", "Remove this plot");
    row.append(this.source, this.quantity, log, remove);
    this.value = document.createElement("p");
    this.value.className = "value";
    this.picture = document.createElement("div");
    this.picture.className = "picture";
    this.picture.setAttribute("role", "img");
    this.root.append(row, this.value, this.picture);
    this.source.addEventListener("change", () => { this.#list(0); this.draw(); });
    this.quantity.addEventListener("change", () => this.draw());
    this.log.addEventListener("change", () => this.draw());
    remove.addEventListener("click", () => board.remove(this));
    new ResizeObserver(() => this.#resize()).observe(this.picture);
    this.#list(quantity);
  }

  #list(chosen) {
    this.quantity.replaceChildren(...this.board.sources[this.source.value].quantities.map((q, k) => new Option(q.name, k)));
    this.quantity.value = chosen;
  }
  get what() { return this.board.sources[this.source.value].quantities[this.quantity.value]; }

  draw() {
    const { what, board } = this, style = getComputedStyle(document.documentElement);
    const colour = (name) => style.getPropertyValue(`--${name}`).trim();
    const log = this.log.checked;
    this.curves = what.curves.map((curve) => ({ ...curve, values: curve.values() }));
    // Logarithms are drawn on an even scale and labelled with what they are of: uPlot's own ends at 1e-16.
    const shown = (values) => (log ? Array.from(values, (x) => (x === 0 ? null : Math.log10(Math.abs(x)))) : values);
    const level = (v) => (log ? tick(Number((10 ** v).toPrecision(2))) : tick(v));
    const tables = this.curves.map((curve) => [curve.t, shown(curve.values)]);
    const drawn = tables.length > 1 ? uPlot.join(tables) : tables[0];
    const axis = { stroke: colour("soft"), grid: { stroke: colour("line"), width: 1 }, ticks: { stroke: colour("line") },
      font: "12px system-ui, sans-serif", labelFont: "12px system-ui, sans-serif" };
    this.chart?.destroy();
    this.chart = new uPlot({
      width: Math.max(50, this.picture.clientWidth), height: this.picture.clientHeight,
      legend: { show: false }, cursor: { drag: { x: false, y: false }, points: { show: false }, y: false },
      scales: { x: { time: false }, y: log ? { range: () => decades(drawn.slice(1)) } : {} },
      axes: [{ ...axis, label: "t, s", labelSize: 16, size: 34, values: (_, v) => v.map(tick) },
             { ...axis, label: what.unit, labelSize: 18, size: 62, values: (_, v) => v.map(level), ...(log ? { incrs: DECADES } : {}) }],
      series: [{}, ...this.curves.map((curve) => ({
        stroke: colour(curve.motion === null ? "ink" : curve.motion === 0 ? "first" : "second"), width: 1.6,
        dash: curve.motion === 1 ? [7, 4] : undefined, spanGaps: true, points: { show: false } }))],
    }, drawn, this.picture);
    this.now = document.createElement("div");
    this.now.className = "now";
    this.chart.over.append(this.now);
    const scrub = (event) => board.seek(this.chart.posToVal(event.offsetX, "x"));
    this.chart.over.addEventListener("pointerdown", (event) => {
      this.chart.over.setPointerCapture(event.pointerId);
      scrub(event);
    });
    this.chart.over.addEventListener("pointermove", (event) => { if (event.buttons & 1) scrub(event); });
    this.mark(board.time);
  }

  #resize() {
    if (!this.chart || this.picture.clientWidth < 50) return;
    this.chart.setSize({ width: this.picture.clientWidth, height: this.picture.clientHeight });
    this.mark(this.board.time);
  }

  // The line at the time shown; the value as text ten times a second while it plays.
  mark(time, playing = false) {
    const at = this.chart.valToPos(time, "x");
    this.now.style.transform = `translateX(${at - 1}px)`;
    this.now.hidden = !(at >= 0 && at <= this.chart.over.clientWidth + 1);
    if (playing && performance.now() - this.told < 100) return;
    this.told = performance.now();
    const { what } = this;
    const values = this.curves.map((curve) => {
      const n = curve.t.length;
      if (n === 0 || time > curve.t[n - 1] || time < curve.t[0]) return null;
      let low = 0, high = n - 1;
      while (low < high) {
        const middle = (low + high + 1) >> 1;
        if (curve.t[middle] <= time) low = middle; else high = middle - 1;
      }
      const next = Math.min(low + 1, n - 1), width = curve.t[next] - curve.t[low];
      return curve.values[low] + (width > 0 ? (time - curve.t[low]) / width : 0) * (curve.values[next] - curve.values[low]);
    });
    const text = values.map((x) => number(x) + (what.unit && x !== null ? ` ${what.unit}` : "")).join("  |  ");
    this.value.textContent = `now: ${text}`;
    this.picture.setAttribute("aria-label", `${this.board.sources[this.source.value].name}: ${what.name} over time; now ${text}`);
  }
}

export class Plots {
  constructor(root, data, motions, seek) {
    this.sources = sources(data, motions);
    this.seek = seek;
    this.time = motions[0].start;
    this.root = root;
    this.list = [];
    const more = document.createElement("button");
    more.type = "button";
    more.textContent = "Add a plot";
    more.addEventListener("click", () => this.add(0, 0, false));
    this.more = document.createElement("div");
    this.more.append(more);
    root.append(this.more);
    const violation = data.curves.findIndex((curve) => curve.name.startsWith("violation"));
    const mechanism = this.sources.findIndex((source) => source.name === "mechanism" && source.quantities.length === data.curves.length);
    if (data.apart) this.add(0, 0, true);
    this.add(mechanism, 0, false);
    if (!data.apart) this.add(mechanism, violation, true);
  }

  add(source, quantity, logarithmic) {
    const plot = new Plot(this, source, quantity, logarithmic);
    this.list.push(plot);
    this.root.insertBefore(plot.root, this.more);
    plot.draw();
    plot.source.value = source;
  }
  remove(plot) {
    this.list.splice(this.list.indexOf(plot), 1);
    plot.root.remove();
    this.more.firstChild.focus();
  }
  mark(time, playing) {
    this.time = time;
    for (const plot of this.list) plot.mark(time, playing);
  }
  redraw() { for (const plot of this.list) plot.draw(); }
}
