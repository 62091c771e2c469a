// --json: what a command says, for programs. The keys are in README.md.
#pragma once

#include <CLI/CLI.hpp>
#include <cstdio>
#include <nlohmann/json_fwd.hpp>

namespace poinsot::app {

void add_json(CLI::App& command, bool& json);
// Names may hold bytes that are not UTF-8.
void print_json(std::FILE* out, const nlohmann::ordered_json& json);

}  // namespace poinsot::app
