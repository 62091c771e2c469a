// The record beside the results: what was computed, how it ended, from what input and by which program.
#pragma once

#include <filesystem>
#include <nlohmann/json_fwd.hpp>
#include <string>
#include <utility>
#include <vector>

#include "core/scene.h"
#include "integrators/simulate.h"

namespace poinsot::app {

struct RunRecord {
  std::filesystem::path scene_file;
  const Scene& scene;
  std::string configuration;  // JSON, as resolved: a configuration file that repeats the run
  const Outcome& outcome;
  std::vector<std::pair<std::string, std::vector<std::string>>> columns = {};  // by option, of files without a header
};

std::string to_json(const RunRecord& record);

// "program" and "processor": which program computed it, where.
void add_origin(nlohmann::ordered_json& json);

}  // namespace poinsot::app
