// Bundles the page and writes it as C++: build.js PAGE WORK OUTPUT. WORK holds node_modules.
//
// The script is packed (gzip, base64) and unpacked by the browser: a third of its size. The licences of what is bundled
// stand in the page as text.

import { createRequire } from "node:module";
import { readFileSync, writeFileSync } from "node:fs";
import { join } from "node:path";
import { gzipSync } from "node:zlib";

const [page, work, output] = process.argv.slice(2);
const modules = join(work, "node_modules");
const { build } = createRequire(join(work, "package.json"))("esbuild");

async function bundle(entry) {
  const result = await build({
    entryPoints: [join(page, entry)], bundle: true, minify: true, write: false, target: "es2022", format: "iife",
    charset: "ascii", legalComments: "none", nodePaths: [modules], logLevel: "error",
  });
  return result.outputFiles[0].text;
}

const licences = ["three", "uplot"].map((name) => {
  const { version } = JSON.parse(readFileSync(join(modules, name, "package.json"), "utf8"));
  return `${name} ${version}\n\n${readFileSync(join(modules, name, "LICENSE"), "utf8").trim()}`;
}).join("\n\n");

const parts = {
  licences: licences.replaceAll("--", "- -"),
  style: (await bundle("style.css")).trim(),
  script: gzipSync(await bundle("main.js"), { level: 9 }).toString("base64"),
};
const text = readFileSync(join(page, "page.html"), "utf8").replace(/{{(licences|style|script)}}/g, (_, name) => parts[name]);
const [before, after] = text.split("{{data}}");

// Pieces, because a string literal may be only so long.
const pieces = (part) => part.match(/[^]{1,8000}/g).map((piece) => `    R"~~~(${piece})~~~"sv,`).join("\n");
writeFileSync(output, `#include "bench/view/bundle.h"

namespace poinsot::view {
using namespace std::string_view_literals;
namespace {

constexpr std::string_view kBefore[] = {
${pieces(before)}
};
constexpr std::string_view kAfter[] = {
${pieces(after)}
};

}  // namespace

std::span<const std::string_view> bundle_before() {
  return kBefore;
}
std::span<const std::string_view> bundle_after() {
  return kAfter;
}

}  // namespace poinsot::view
`);
