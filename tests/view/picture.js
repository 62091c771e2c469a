// Makes the README's picture, the four link as `poinsot view` shows it: picture.js PROGRAM SOURCE WORK [OUT.png].
// Without OUT it is made again and held against the one in the README: the two may differ by how a browser draws edges.

import { execFileSync, spawnSync } from "node:child_process";
import { mkdtempSync, readFileSync, rmSync, statSync, writeFileSync } from "node:fs";
import { tmpdir } from "node:os";
import { join, resolve } from "node:path";
import { pathToFileURL } from "node:url";
import { browserPath, launch, library, skip } from "./browser.js";

const [program, source, work, out] = process.argv.slice(2).map((path) => resolve(path));
const CLOSER = 4;
const MOST_BYTES = 300e3, MOST_DIFFERENCE = 6;  // of 255, mean over the pixels
const committed = join(source, "bench/view/picture.png");

if (/without the page/.test(spawnSync(program, ["view", "none.json", "--out", "none.html"], { encoding: "utf8" }).stderr))
  skip("the program was built without it (npm was not found)");
const executablePath = browserPath();
const folder = mkdtempSync(join(tmpdir(), "poinsot-picture-"));
const browser = await launch(library(work), executablePath);
try {
  execFileSync(program, ["view", join(source, "models/four_link.json"), "--end", "2", "--every", "0.01", "--out", join(folder, "motion.html"), "--quiet"]);
  const page = await (await browser.newContext({ viewport: { width: 1200, height: 760 }, colorScheme: "light" })).newPage();
  await page.goto(pathToFileURL(join(folder, "motion.html")).href);
  await page.waitForFunction(() => window.poinsot?.drawn > 0, null, { timeout: 20000 });
  await page.selectOption("#point", { label: await page.locator("#point option").last().textContent() });
  await page.click("#trace");
  await page.focus("#canvas");
  for (let k = 0; k < CLOSER; ++k) await page.keyboard.press("+");
  await page.evaluate(() => {
    const slider = document.getElementById("time");
    slider.value = 1.2;
    slider.dispatchEvent(new Event("input", { bubbles: true }));
    return new Promise((done) => requestAnimationFrame(() => requestAnimationFrame(done)));
  });
  await page.evaluate(() => document.activeElement.blur());
  const png = await page.locator("#canvas").screenshot();
  if (out) {
    writeFileSync(out, png);
  } else {
    const difference = await page.evaluate(async (pictures) => {
      const [a, b] = await Promise.all(pictures.map(async (data) => {
        const image = new Image();
        image.src = `data:image/png;base64,${data}`;
        await image.decode();
        const canvas = new OffscreenCanvas(image.width, image.height), draw = canvas.getContext("2d");
        draw.drawImage(image, 0, 0);
        return draw.getImageData(0, 0, image.width, image.height).data;
      }));
      return a.length === b.length ? a.reduce((sum, value, k) => sum + Math.abs(value - b[k]), 0) / a.length : Infinity;
    }, [png, readFileSync(committed)].map((data) => data.toString("base64")));
    const small = statSync(committed).size < MOST_BYTES;
    console.log(`the pictures differ by ${difference} of 255 in the mean; ${statSync(committed).size} bytes`);
    process.exitCode = difference < MOST_DIFFERENCE && small ? 0 : 1;
  }
} finally {
  await browser.close();
  rmSync(folder, { recursive: true });
}
