// All the paper's tables, measured: its mechanisms at its settings in every formulation and with every Newton matrix,
// and in one more table with every linear solver.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "bench/study/progress.h"
#include "bench/study/report.h"
#include "integrators/settings.h"

namespace poinsot::paper {

struct TablesRequest {
  std::filesystem::path models;
  std::string linear_solver = Settings{}.linear_solver;  // of all tables but the one that compares them
  int repetitions = 11;
  bool quick = false;  // a tenth of the simulated time and at most 5 repetitions

  double end() const;  // s
  int runs() const;    // of each cell
};

struct MeasuredTables {
  study::Report report;
  study::Table raw;  // every repetition of every cell
  // Cells without figures, a sentence each; what a linear solver refuses is no failure, and the table of linear solvers
  // tells it.
  std::vector<std::string> failures;
};

// `core`: as pin_to_one_core() returns it. Where it is interrupted (core/interruption.h): of the runs up to there.
MeasuredTables measure_tables(const TablesRequest& request, int core, const study::ProgressCallback& progress);

}  // namespace poinsot::paper
