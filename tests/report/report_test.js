// Looks at the page of `poinsot report` in a browser: report_test.js PROGRAM SOURCE WORK [FOLDER SHOTS]. Needs what
// tests/view/browser.js says.
//
// Without FOLDER a small one is computed. With SHOTS the pictures of the page are left there, to be looked at.

import { execFileSync } from "node:child_process";
import { mkdirSync, mkdtempSync, readFileSync, readdirSync, rmSync, statSync, writeFileSync } from "node:fs";
import { tmpdir } from "node:os";
import { basename, join, resolve } from "node:path";
import { browserPath, conclude, expect, expectAccessible, launch, library, openPage } from "../view/browser.js";

const [program, source, work, given, shots] = process.argv.slice(2).map((path) => resolve(path));
const MOST_BYTES = 5e6;
const EVIL = "</script><script>window.hacked = 1</script><img src=x onerror=\"window.hacked = 2\"> =1+1|'";

const folder = given ?? join(mkdtempSync(join(tmpdir(), "poinsot-report-")), "results");
const poinsot = (...words) => execFileSync(program, words, { cwd: join(folder, ".."), encoding: "utf8", stdio: ["ignore", "pipe", "pipe"] });

function make() {
  mkdirSync(folder, { recursive: true });
  const evil = join(folder, "..", "evil.json");
  writeFileSync(evil, JSON.stringify({ scene: 1, name: EVIL, gravity: [0, 0, -9.81],
    bodies: [{ name: EVIL, mass: 3, inertia: [1, 0.01, 1], position: [0, 1, 0] }],
    joints: [{ type: "revolute", bodies: ["ground", EVIL], point: [0, 0, 0], axis: [1, 0, 0] }] }));
  poinsot("tables", "--quick", "--repetitions", "2", "--quiet", "--out", folder, "--models", join(source, "models"));
  poinsot("chart", evil, join(source, "models/single_pendulum.json"), "--quick", "--end", "0.5", "--quiet", "--out", folder,
          "--cache", join(folder, "../cache"), "--integrators", "implicit_euler,dop853");
  const study = join(folder, "..", "study.json");
  writeFileSync(study, JSON.stringify({ study: 1, name: EVIL, about: "two mechanisms", repetitions: 2,
    scenes: ["single_pendulum", "double_pendulum"].map((name) => join(source, `models/${name}.json`)),
    settings: { integrator: "implicit_euler", step: 1e-3, end: 0.02 }, vary: [{ setting: "formulation", values: ["rA", "rp"] }],
    keep: ["seconds"], pictures: [{ file: "speed_up", title: "time over that of rA",
                                    ratio: { of: "seconds", by: "formulation", to: "rA", over: "bodies" } }] }));
  poinsot("study", study, "--quiet", "--out", join(folder, "small"));
}

// Fields of a CSV file, and all its text.
function fields(line) {
  return [...line.matchAll(/(?:^|,)(?:"((?:[^"]|"")*)"|([^,]*))/g)].map((m) => (m[1] !== undefined ? m[1].replaceAll('""', '"') : m[2]));
}
function csv(file) {
  const lines = readFileSync(join(folder, file), "utf8").split("\n").filter((line) => line && !line.startsWith("#"));
  return lines.map(fields);
}

// Every table that a link below it names holds the fields of that file, in its order.
async function holdsTheTables(page) {
  const tables = await page.evaluate(() => [...document.querySelectorAll("table")].map((table) => {
    const block = table.closest("details") ?? table.closest(".scroll");
    return { file: block.nextElementSibling.querySelector("a").textContent,
             rows: [...table.rows].map((row) => [...row.cells].map((cell) => cell.textContent.trimEnd())) };
  }));
  expect(tables.length > 8, `there are tables, found ${tables.length}`);
  const squeeze = (rows) => JSON.stringify(rows).replaceAll(/\s+/g, " ");
  for (const { file, rows } of tables) expect(squeeze(rows) === squeeze(csv(file)), `the table of ${file} holds its fields`);
}

// Every word with a digit that the page shows, but for the ticks of axes, stands in a file beside it.
async function saysNothingOfItsOwn(page) {
  const words = (text) => new Set((text.match(/[\w.+\-−]*\d[\w.+\-]*/g) ?? []).map((word) => word.replace(/[.-]+$/, "")));
  const known = words(readdirSync(folder, { recursive: true }).filter((file) => file.endsWith(".csv")).map((file) => `${readFileSync(join(folder, file), "utf8")}\n${file}`).join("\n"));
  const shown = words(await page.evaluate(() => {
    const copy = document.body.cloneNode(true), words = [];
    for (const one of copy.querySelectorAll("script, .tick")) one.remove();
    const walk = document.createTreeWalker(copy, NodeFilter.SHOW_TEXT);
    while (walk.nextNode()) words.push(walk.currentNode.data);
    return words.join("\n");
  }));
  const unknown = [...shown].filter((word) => !known.has(word));
  expect(shown.size > 100 && unknown.length === 0, `every number stands in a table, found beside them ${unknown.slice(0, 10).join(" ")}`);
}

async function works(page) {
  await page.keyboard.press("Tab");
  expect(await page.evaluate(() => document.activeElement.className) === "skip", "the first stop is the skip link");
  await page.keyboard.press("Enter");
  expect(await page.evaluate(() => document.activeElement.id) === "main", "it goes to the findings");
  const heading = page.locator("table thead th").nth(1), table = page.locator("table").first();
  const column = () => table.locator("tbody tr").evaluateAll((rows) => rows.map((row) => row.cells[1].textContent));
  await table.evaluate((one) => { const folded = one.closest("details"); if (folded) folded.open = true; });
  await heading.locator("button").focus();
  await page.keyboard.press("Enter");
  const up = await column();
  expect(await heading.getAttribute("aria-sort") === "ascending", "a heading sorts by keyboard and says so");
  expect(JSON.stringify(up) === JSON.stringify([...up].sort((a, b) => a.localeCompare(b))), "rows are sorted");
  await page.keyboard.press("Enter");
  expect(await heading.getAttribute("aria-sort") === "descending", "pressed again it turns round");
}

if (!given) make();
poinsot("report", basename(folder), "--quiet");
expect(statSync(join(folder, "report.html")).size < MOST_BYTES, "the page is below 5 MB");
expect(readdirSync(folder).includes("report_findings.csv"), "the numbers of the findings stand beside it");
const executablePath = browserPath(), require = library(work);
const browser = await launch(require, executablePath), report = join(folder, "report.html");
try {
  for (const dark of [false, true])
    for (const width of [1400, 800, 390]) {
      const what = `${width} pixels, ${dark ? "dark" : "light"}`, { page, close } = await openPage(browser, report, { width, dark });
      expect(await page.evaluate(() => document.documentElement.scrollWidth <= innerWidth), `${what}: nothing is wider than the window`);
      if (width !== 800) await expectAccessible(page, require, what);
      if (width === 1400 && !dark) {
        await holdsTheTables(page);
        await saysNothingOfItsOwn(page);
        expect(await page.evaluate(() => window.hacked === undefined && document.querySelectorAll("img").length === 0), "no name becomes markup");
        if (!given) {
          expect((await page.locator("h3").allTextContents()).filter((text) => text === EVIL).length === 2, "the names of a scene and of a study stand as they are");
          expect((await page.locator("section[aria-labelledby=studies] li").count()) === 1, "what a study of formulations shows is a finding");
        }
        expect(await page.locator("svg[role=img]:not([aria-label])").count() === 0, "every picture has a text");
        await works(page);
      }
      if (shots) {
        mkdirSync(shots, { recursive: true });
        await page.screenshot({ path: join(shots, `report_${width}_${dark ? "dark" : "light"}.png`), fullPage: true });
      }
      await close(what);
    }
  const { page, close } = await openPage(browser, report, { width: 688, dark: true });  // A4 within usual margins
  await page.emulateMedia({ media: "print" });
  expect(await page.evaluate(() => getComputedStyle(document.body).backgroundColor) === "rgb(255, 255, 255)", "paper is light");
  expect(await page.locator("nav").isHidden(), "navigation is not printed");
  expect(await page.evaluate(() => document.documentElement.scrollWidth <= innerWidth), "nothing is wider than the sheet");
  expect(await page.locator("thead th").evaluateAll((all) => all.every((one) => getComputedStyle(one).position === "static")), "headings of tables stand on every sheet");
  expect(await page.locator("details[open]").count() === 0, "what is folded stays so");
  if (shots) await page.pdf({ path: join(shots, "report.pdf"), format: "A4" });
  await close("print");
} finally {
  await browser.close();
  if (!given) rmSync(join(folder, ".."), { recursive: true });
}
conclude();
