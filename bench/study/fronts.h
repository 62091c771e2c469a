// On which fronts of several charts each method stands: what earns its place, and what does not.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "bench/study/chart_file.h"
#include "bench/study/panels.h"
#include "bench/study/report.h"

namespace poinsot::study {

struct SceneChart {
  std::string scene;
  std::vector<ChartRow> rows;  // with their fronts
  PerQuantity agreement{};     // of the reference
  bool prescribed = false;     // drivers prescribe all positions
};

// The charts of all other scenes that lie in the folder, of sweeps before. What is torn or was interrupted is left out,
// and told.
std::vector<SceneChart> charts_before(const std::filesystem::path& folder, const std::vector<SceneChart>& anew,
                                      std::vector<std::string>& notices);

// "For this accuracy on this kind of scene take this": by kind (kSceneKinds), quantity and accuracy the method that is
// the fastest, or not apart from it, on most of the charts.
Table choice_table(const std::vector<SceneChart>& charts);
// A panel for each scene: time against the error in positions, of each integrator in the formulation that is cheapest.
PanelPlot fronts_plot(const std::vector<SceneChart>& charts);

// Tables by integrator and by method (integrator, formulation and linear solver): of each quantity, the number of
// charts on whose front it stands, and the scenes of those it stands on with any. `integrators`: every one that was
// asked for.
Report fronts_report(const std::vector<std::string>& integrators, const std::vector<SceneChart>& charts,
                     const std::vector<std::string>& foot);

// The same in a few lines: a line for each method on a front, and the integrators that are on none.
std::string fronts_summary(const std::vector<std::string>& integrators, const std::vector<SceneChart>& charts);

}  // namespace poinsot::study
