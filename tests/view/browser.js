// What looking at a page needs: Chromium, and from npm playwright-core and axe-core, which are installed in a folder of
// the build. Where there is none of them it is said, and the test ends with 77: skipped. What holds of a page is
// expected of it, and counted.

import { spawnSync } from "node:child_process";
import { copyFileSync, existsSync, mkdirSync, readFileSync, writeFileSync } from "node:fs";
import { createRequire } from "node:module";
import { dirname, join } from "node:path";
import { fileURLToPath, pathToFileURL } from "node:url";

const here = dirname(fileURLToPath(import.meta.url));

export function skip(why) {
  const line = "*".repeat(100);
  console.log(`${line}\nSKIPPED, the page was not looked at: ${why}\n${line}`);
  process.exit(77);
}

export function browserPath() {
  for (const name of ["chromium", "chromium-browser", "google-chrome"]) {
    const found = spawnSync("which", [name], { encoding: "utf8" });
    if (found.status === 0) return found.stdout.trim();
  }
  return skip("no browser was found (Debian: chromium)");
}

export function library(work) {
  mkdirSync(work, { recursive: true });
  const lock = readFileSync(join(here, "package-lock.json"), "utf8"), installed = join(work, "installed-lock.json");
  if (!existsSync(installed) || readFileSync(installed, "utf8") !== lock) {
    for (const file of ["package.json", "package-lock.json"]) copyFileSync(join(here, file), join(work, file));
    const done = spawnSync("npm", ["ci", "--ignore-scripts", "--no-audit", "--no-fund", "--loglevel=error"], { cwd: work, encoding: "utf8", timeout: 120000 });
    if (done.status !== 0) skip(`npm could not install playwright-core and axe-core: ${(done.stderr ?? String(done.error)).split("\n")[0]}`);
    writeFileSync(installed, lock);
  }
  return createRequire(join(work, "package.json"));
}

let failures = 0, checks = 0;
export function expect(holds, what) {
  ++checks;
  if (holds) return;
  ++failures;
  console.log(`FAILED: ${what}`);
}
// Says how many there were and ends the program.
export function conclude() {
  console.log(`${checks} checks, ${failures} failed`);
  process.exit(failures > 0 ? 1 : 0);
}

// Software renders WebGL where there is no graphics processor, and puts the page together outside WebGL.
export function launch(require, executablePath) {
  const args = ["--no-sandbox", "--use-gl=angle", "--use-angle=swiftshader", "--enable-unsafe-swiftshader", "--disable-gpu-compositing"];
  return require("playwright-core").chromium.launch({ executablePath, args });
}

// The page of a file, which must have no error and ask for nothing until it is closed.
export async function openPage(browser, file, { width = 1400, height = 900, dark = false, before } = {}) {
  const context = await browser.newContext({ viewport: { width, height }, colorScheme: dark ? "dark" : "light" });
  const page = await context.newPage(), troubles = [], url = pathToFileURL(file).href;
  page.on("console", (message) => { if (message.type() === "error") troubles.push(message.text()); });
  page.on("pageerror", (error) => troubles.push(String(error)));
  page.on("request", (request) => { if (request.url() !== url && !/^(data|blob):/.test(request.url())) troubles.push(`asks for ${request.url()}`); });
  if (before) await page.addInitScript(before);
  await page.goto(url);
  return { page, async close(what) {
    expect(troubles.length === 0, `${what}: no error and no request, found ${troubles.join("; ")}`);
    await context.close();
  } };
}

// No serious fault is found by axe-core. It is run as by a program that looks on, not as the page's own script, whose
// policy may forbid strings as code.
export async function expectAccessible(page, require, what) {
  await page.evaluate(readFileSync(require.resolve("axe-core/axe.min.js"), "utf8"));
  const found = await page.evaluate(() => axe.run(document, { resultTypes: ["violations"] }));
  const serious = found.violations.filter((one) => ["serious", "critical"].includes(one.impact));
  const told = serious.map((one) => `${one.id}: ${one.nodes.slice(0, 3).map((node) => `${node.target} ${node.failureSummary}`).join(" ")}`);
  expect(serious.length === 0, `${what}: accessible, found ${told.join("; ")}`);
}
