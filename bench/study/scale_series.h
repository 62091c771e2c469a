// How time and memory grow with the number of bodies: runs of generated scenes of growing size, their tables, the
// exponents fitted to them, the plot.
#pragma once

#include <string>
#include <vector>

#include "bench/study/isolated_run.h"
#include "bench/study/panels.h"
#include "bench/study/progress.h"
#include "bench/study/report.h"

namespace poinsot::study {

struct Series {  // one structure, formulation and linear solver over growing sizes
  const SceneGenerator* structure;
  Settings settings;
  std::vector<int> sizes;                      // bodies asked for
  std::vector<std::vector<IsolatedRun>> runs;  // by size, by repetition
};

struct ScaleRequest {
  std::vector<std::string> formulations, linear_solvers;
  int most = 100000;  // bodies; sizes are 1, 10, 100, ...
  int repetitions = 3;
};
// Every structure; repetitions go through all of them in turn. Sizes that would take too long are left out. Where it is
// interrupted (core/interruption.h) the runs up to there are returned.
std::vector<Series> measure_scale(const ScaleRequest& request, const ProgressCallback& progress);

// Why there are no figures, a sentence for each size of each series that has none. Those left out are no failures.
struct Missing {
  std::string why;
  bool failed;
};
std::vector<Missing> missing(const std::vector<Series>& all);

bool good(const std::vector<IsolatedRun>& runs);

// Medians over the repetitions, a row for every scene.
Table cost_table(const std::vector<Series>& all);
// Exponents of the number of bodies.
Table growth_table(const std::vector<Series>& all);
PanelPlot scaling_plot(const std::vector<Series>& all);
// The two tables; the foot says where the numbers come from. `core`: as pin_to_one_core() returns it.
Report scale_report(const std::vector<Series>& all, int repetitions, int core);

}  // namespace poinsot::study
