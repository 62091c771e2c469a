// What looking at a page needs: Chromium, and from npm playwright-core and axe-core, which are installed in a folder of
// the build. Where there is none of them it is said, and the test ends with 77: skipped.

import { spawnSync } from "node:child_process";
import { copyFileSync, existsSync, mkdirSync, readFileSync, writeFileSync } from "node:fs";
import { createRequire } from "node:module";
import { dirname, join } from "node:path";
import { fileURLToPath } from "node:url";

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
