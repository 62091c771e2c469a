// What `poinsot scale` has measured: runs of growing scenes, their tables, the exponents fitted to them, the plot.
#pragma once

#include <vector>

#include "bench/study/isolated_run.h"
#include "bench/study/panels.h"
#include "bench/study/report.h"

namespace poinsot::study {

struct Series {  // one structure, formulation and linear solver over growing sizes
  const SceneGenerator* structure;
  Settings settings;
  std::vector<std::vector<IsolatedRun>> runs;  // by size, by repetition
};

bool good(const std::vector<IsolatedRun>& runs);

// Medians over the repetitions, a row for every scene.
Table cost_table(const std::vector<Series>& all);
// Exponents of the number of bodies.
Table growth_table(const std::vector<Series>& all);
PanelPlot scaling_plot(const std::vector<Series>& all);

}  // namespace poinsot::study
