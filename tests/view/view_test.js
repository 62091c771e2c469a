// Looks at the page of `poinsot view` in a browser: view_test.js PROGRAM SOURCE WORK [SHOTS]. Needs what browser.js says;
// where the program was built without the page it says so and ends with 77: skipped.
//
// With SHOTS pictures of four mechanisms are left there, to be looked at.

import { execFileSync, spawnSync } from "node:child_process";
import { mkdirSync, mkdtempSync, readFileSync, rmSync, writeFileSync } from "node:fs";
import { tmpdir } from "node:os";
import { join, resolve } from "node:path";
import { browserPath, conclude, expect, expectAccessible, launch, library, openPage, skip } from "./browser.js";

const [program, source, work, shots] = process.argv.slice(2).map((path) => resolve(path));

const folder = mkdtempSync(join(tmpdir(), "poinsot-view-"));
const poinsot = (...words) => execFileSync(program, words, { cwd: folder, encoding: "utf8", stdio: ["ignore", "pipe", "pipe"] });

// Rows of a trajectory by column name; the names here need no quotes.
function rows(file) {
  const [header, ...lines] = readFileSync(join(folder, file), "utf8").trim().split("\n").map((line) => line.split(","));
  return lines.map((line) => Object.fromEntries(header.map((name, k) => [name, Number(line[k])])));
}

const EVIL = ["</script><script>window.hacked = 1</script>", "\"><img src=x onerror=\"window.hacked = 2\">", "'; window.hacked = 3; '",
  "line\u2028separators\u2029 & <b>bold</b>", "=1+1|{{data}}", "<!--"];
const EVIL_SCENE = {
  scene: 1, name: EVIL[0], about: EVIL[1], gravity: [0, 0, -9.81],
  bodies: EVIL.map((name, k) => ({ name, mass: 1, inertia: [1, 2, 2.5], position: [k, 0, 0], angular_velocity: [0.1, 2, 0.1] })),
  joints: [{ type: "spherical", name: EVIL[2], bodies: ["ground", EVIL[0]], point: [0, 0, 1] }],
  forces: [{ type: "force", name: EVIL[3], body: EVIL[1], point: [0, 0, 0], force: [0, "5*sin(t)", 0] },
           { type: "torque", name: EVIL[5], body: EVIL[2], torque: [0, 0, 1] },
           { type: "spring", bodies: [EVIL[3], EVIL[4]], s_i: [0, 0, 0], s_j: [0, 0, 0], stiffness: 10, damping: 0, length: 1 }],
};

class Looker {
  constructor(browser, require) {
    this.browser = browser;
    this.require = require;
  }

  async open(file, options = {}) {
    Object.assign(this, await openPage(this.browser, join(folder, file), options));
    await this.page.waitForFunction(() => window.poinsot?.drawn > 0, null, { timeout: 60000 });
  }

  seek(t) {
    return this.page.evaluate((time) => {
      const slider = document.getElementById("time");
      slider.value = time;
      slider.dispatchEvent(new Event("input", { bubbles: true }));
      return new Promise((done) => requestAnimationFrame(() => requestAnimationFrame(done)));
    }, t);
  }

  // How many colours the picture has, and a sum over it that changes with it.
  async picture() {
    const png = (await this.page.locator("#canvas").screenshot()).toString("base64");
    return this.page.evaluate(async (data) => {
      const image = new Image();
      image.src = `data:image/png;base64,${data}`;
      await image.decode();
      const canvas = new OffscreenCanvas(image.width, image.height), draw = canvas.getContext("2d");
      draw.drawImage(image, 0, 0);
      const pixels = new Uint32Array(draw.getImageData(0, 0, image.width, image.height).data.buffer);
      let sum = 0;
      for (const pixel of pixels) sum = (31 * sum + pixel) >>> 0;
      return { colours: new Set(pixels).size, sum };
    }, png);
  }

  accessible(what) { return expectAccessible(this.page, this.require, what); }
  state(what) { return this.page.evaluate((name) => window.poinsot[name], what); }
}

async function shows(looker) {
  poinsot("run", join(source, "models/slider_crank.json"), "--end", "1", "--every", "0.01", "--out", "crank.csv", "--quiet");
  poinsot("view", join(source, "models/slider_crank.json"), "--trajectory", "crank.csv", "--out", "crank.html");
  await looker.open("crank.html");
  const { page } = looker;
  expect(await page.evaluate(() => !document.getElementById("canvas").getContext("webgl2").isContextLost()), "the WebGL context is alive");
  expect((await page.title()).startsWith("slider crank"), "the title names the scene");

  const first = await looker.picture();
  expect(first.colours > 50, `the picture is not blank, found ${first.colours} colours`);
  await looker.seek(0.3);
  expect((await looker.picture()).sum !== first.sum, "two times differ");

  const table = rows("crank.csv");
  for (let k = 0; k < table.length; k += 5) {
    await looker.seek(table[k].t);
    for (const body of ["crank", "connecting rod", "slider"]) {
      const pose = await page.evaluate((name) => window.poinsot.pose(name), body);
      const names = ["x", "y", "z", "e0", "e1", "e2", "e3"].map((name) => table[k][`${body}.${name}`]);
      const away = Math.max(...[...pose.position, ...pose.orientation].map((x, n) => Math.abs(x - names[n])));
      const turned = Math.max(...pose.orientation.map((x, n) => Math.abs(x + names[3 + n])));  // −p is the same where e0 = 0
      expect(away < 1e-6 || (Math.abs(names[3]) < 1e-6 && turned < 1e-6), `the pose of ${body} at ${table[k].t} s is the file's, off by ${away}`);
    }
  }

  await looker.seek(0);
  await page.click("#play");
  await page.waitForFunction(() => Number(document.getElementById("time").value) > 0.01, null, { timeout: 10000 });
  expect(await looker.state("playing"), "play plays and moves the scrubber");
  await page.click("#play");
  expect(!(await looker.state("playing")), "pause pauses");
  return looker.close("the page of a trajectory");
}

async function keys(looker) {
  await looker.open("crank.html", { width: 800, height: 700 });
  const { page } = looker, press = (key) => page.keyboard.press(key), time = () => looker.state("time");
  await press("End");
  expect(Math.abs(await time() - 1) < 1e-12, "End goes to the end");
  await press("Home");
  expect(await time() === 0, "Home goes to the start");
  await press(".");
  expect(Math.abs(await time() - 0.01) < 1e-12, "a full stop goes on by a frame");
  await press("Shift+ArrowRight");
  expect(Math.abs(await time() - 0.11) < 1e-12, "shift and an arrow go on by ten");
  await press(",");
  expect(Math.abs(await time() - 0.1) < 1e-12, "a comma goes back by one");
  await press("Space");
  expect(await looker.state("playing"), "space plays");
  await press("Space");
  expect(!(await looker.state("playing")), "space pauses");
  const speed = await page.inputValue("#speed");
  await press("]");
  expect(Number(await page.inputValue("#speed")) > Number(speed), "] is faster");
  await page.focus("#canvas");
  await looker.seek(0.1);
  const before = await looker.picture();
  await press("ArrowLeft");
  await page.waitForTimeout(100);
  const turned = await looker.picture();
  expect(turned.sum !== before.sum && await time() === 0.1, "an arrow in the picture turns it");
  await press("1");
  await page.waitForTimeout(100);
  expect((await looker.picture()).sum !== turned.sum, "1 is a view along an axis");
  await press("?");
  expect(await page.locator("dialog[open]").count() === 1, "? lists the keys");
  await looker.accessible("the list of keys");
  await press("Escape");
  expect(await page.locator("dialog[open]").count() === 0, "Escape closes it");
  const seen = new Set();
  for (let k = 0; k < 40; ++k) {
    await press("Tab");
    seen.add(await page.evaluate(() => document.activeElement.id || document.activeElement.textContent));
  }
  for (const id of ["canvas", "play", "time", "speed", "repeat", "bodies", "point", "trace"]) expect(seen.has(id), `Tab reaches ${id}`);
  await page.emulateMedia({ media: "print", colorScheme: "dark" });
  expect(await page.evaluate(() => getComputedStyle(document.body).backgroundColor) === "rgb(255, 255, 255)", "paper is light");
  for (const id of ["play", "views", "trace"]) expect(await page.locator(`#${id}`).isHidden(), `${id} is not printed`);
  for (const id of ["printed", "clock", "bodies"]) expect(await page.locator(`#${id}`).isVisible(), `${id} is printed`);
  await page.pdf();
  const colours = await page.evaluate(() => {
    const copy = document.getElementById("printed"), data = copy.getContext("2d").getImageData(0, 0, copy.width, copy.height).data;
    return { paper: [...data.slice(0, 4)], many: new Set(new Uint32Array(data.buffer)).size };
  });
  expect(colours.many > 20, `the mechanism is printed, found ${colours.many} colours`);
  expect(colours.paper.every((one) => one === 255), `on light paper, found ${colours.paper}`);
  return looker.close("the page at 800 pixels");
}

async function two(looker) {
  poinsot("run", join(source, "models/double_pendulum_joints.json"), "--end", "1", "--step", "0.01", "--integrator", "implicit_euler", "--out", "euler.csv", "--quiet");
  poinsot("run", join(source, "models/double_pendulum_joints.json"), "--end", "0.8", "--step", "0.01", "--integrator", "rattle", "--out", "rattle.csv", "--quiet");
  poinsot("view", join(source, "models/double_pendulum_joints.json"), "--trajectory", "euler.csv", "--trajectory", "rattle.csv", "--out", "two.html");
  const distance = (a, b, name) => Math.hypot(...["x", "y", "z"].map((c) => a[`${name}.${c}`] - b[`${name}.${c}`]));
  const a = rows("euler.csv")[50], b = rows("rattle.csv")[50];
  await looker.open("two.html", { width: 390, height: 844, dark: true });
  const { page } = looker;
  await looker.seek(a.t);
  const names = await looker.state("bodies");
  const apart = Math.max(...names.map((name) => distance(a, b, name)));
  const text = await page.locator(".plot .value").first().textContent();
  expect(Math.abs(Number.parseFloat(text.replace("now: ", "")) - apart) < 1e-4 * apart, `the two are ${apart} m apart, the page says ${text}`);
  const poses = await page.evaluate((name) => [window.poinsot.pose(name, 0).position[2], window.poinsot.pose(name, 1).position[2]], names[1]);
  expect(Math.abs(poses[0] - a[`${names[1]}.z`]) < 1e-6 && Math.abs(poses[1] - b[`${names[1]}.z`]) < 1e-6, "both are shown");
  expect(await page.evaluate(() => document.documentElement.scrollWidth <= innerWidth), "390 pixels are wide enough");
  await page.click("#trace");
  expect(await page.locator("#traces li").count() === 1, "a point is traced");
  await looker.accessible("two motions, dark, 390 pixels");
  return looker.close("the page of two motions");
}

async function names(looker) {
  writeFileSync(join(folder, "evil.json"), JSON.stringify(EVIL_SCENE));
  poinsot("view", "evil.json", "--end", "0.05", "--step", "0.01", "--integrator", "rattle", "--out", "evil.html");
  await looker.open("evil.html");
  const { page } = looker;
  await page.click("#trace");
  expect(await page.evaluate(() => window.hacked === undefined), "no name becomes script");
  expect(await page.evaluate(() => document.querySelectorAll("img, b").length === 0), "no name becomes markup");
  expect(await page.locator("#name").textContent() === EVIL[0], "the scene's name stands as it is");
  expect(JSON.stringify(await page.locator("#bodies li").allTextContents()) === JSON.stringify(EVIL), "the bodies' names stand as they are");
  await looker.accessible("a scene of odd names");
  return looker.close("a scene of odd names");
}

// A thousand bodies at thirty frames a second: what the page's script takes for a frame, the picture left to whoever
// renders it. Software takes longer, and for instances one by one: there are none of many parts.
async function many(looker) {
  const MOST_MS = 1000 / 30;
  poinsot("make", "chain", "--bodies", "1000", "--out", "chain.json");
  poinsot("view", "chain.json", "--integrator", "rattle", "--step", "0.01", "--end", "0.2", "--out", "chain.html", "--quiet");
  await looker.open("chain.html", { before: () => {
    window.frames_ms = [];
    const request = window.requestAnimationFrame.bind(window);
    window.requestAnimationFrame = (draw) => request((now) => {
      const began = performance.now();
      draw(now);
      window.frames_ms.push(performance.now() - began);
    });
    window.instances = 0;
    const { prototype } = WebGL2RenderingContext, instanced = prototype.drawElementsInstanced;
    prototype.drawElementsInstanced = function(...given) {
      window.instances = Math.max(window.instances, given[4]);
      return instanced.apply(this, given);
    };
  } });
  const { page } = looker;
  expect((await looker.state("bodies")).length === 1000, "all bodies are there");
  await page.click("#play");
  await page.evaluate(() => { window.frames_ms.length = 0; });
  await page.waitForFunction(() => window.frames_ms.length >= 20, null, { timeout: 60000 });
  const ms = (await page.evaluate(() => window.frames_ms)).sort((a, b) => a - b), median = ms[Math.floor(ms.length / 2)];
  console.log(`1000 bodies: ${median.toFixed(1)} ms of script a frame, median of ${ms.length}`);
  expect(median < MOST_MS, `a frame of 1000 bodies takes less than ${MOST_MS.toFixed(1)} ms of script, found ${median}`);
  const instances = await page.evaluate(() => window.instances);
  expect(instances <= 300, `many parts are drawn together, found ${instances} instances in a call`);
  return looker.close("the page of 1000 bodies");
}

async function photograph(looker) {
  mkdirSync(shots, { recursive: true });
  for (const [name, end] of [["slider_crank", 1], ["stewart_platform", 1], ["delta_robot", 1], ["gyroscope", 1]]) {
    poinsot("view", join(source, `models/${name}.json`), "--end", String(end), "--out", `${name}.html`, "--quiet");
    for (const dark of [false, true])
      for (const width of [1400, 800, 390]) {
        await looker.open(`${name}.html`, { width, dark });
        await looker.seek(0.6 * end);
        await looker.page.screenshot({ path: join(shots, `${name}_${width}_${dark ? "dark" : "light"}.png`), fullPage: true });
        expect(await looker.page.evaluate(() => document.documentElement.scrollWidth <= innerWidth), `${name}, ${width} pixels: nothing is wider than the window`);
        await looker.close(`${name}, ${width} pixels`);
      }
  }
}

const probe = spawnSync(program, ["view", "none.json", "--out", "none.html"], { encoding: "utf8" });
if (/without the page/.test(probe.stderr)) skip("the program was built without it (npm was not found)");
const executablePath = browserPath(), require = library(work);
const browser = await launch(require, executablePath);
try {
  const looker = new Looker(browser, require);
  for (const part of [shows, keys, two, names, many]) await part(looker);
  if (shots) await photograph(looker);
} finally {
  await browser.close();
  rmSync(folder, { recursive: true });
}
conclude();
