// The record beside the results: what was computed, how it ended, from what input and by which program.
#pragma once

#include <filesystem>
#include <nlohmann/json_fwd.hpp>
#include <string>
#include <utility>
#include <vector>

#include "bench/study/verification.h"
#include "core/scene.h"
#include "integrators/simulate.h"

namespace poinsot::records {

// Of files without a header.
using ColumnsByOption = std::vector<std::pair<std::string, std::vector<std::string>>>;

struct RunRecord {
  std::filesystem::path scene_file;
  const Scene& scene;
  std::string configuration;  // JSON, as resolved: a configuration file that repeats the run
  const Outcome& outcome;
  std::string accuracy;
  const study::Verification* verification = nullptr;
  bool running = false;  // the run goes on
  ColumnsByOption columns = {};
};

std::string to_json(const RunRecord& record);

// "program" and "processor": which program computed it, where.
void add_origin(nlohmann::ordered_json& json);

}  // namespace poinsot::records
