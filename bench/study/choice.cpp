#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <map>

#include "bench/study/cost_curve.h"
#include "bench/study/fronts.h"

namespace poinsot::study {
namespace {

constexpr std::array kAccuracies{1e-2, 1e-4, 1e-6, 1e-8};

// What a chart tells of its scene: whether drivers leave it no freedom, whether its energy is kept.
constexpr std::array<std::string_view, 3> kSceneKinds{kPrescribed, "free, energy is kept",
                                                      "free, energy comes or goes"};

std::size_t kind_of(const SceneChart& chart) {
  if (chart.prescribed) return 0;
  const auto keeps = [](const ChartRow& row) { return row.measured.ok() && std::isfinite(row.measured.energy_drift); };
  return std::ranges::any_of(chart.rows, keeps) ? 1 : 2;
}

}  // namespace

Table choice_table(const std::vector<SceneChart>& charts) {
  Table table{
      "fronts_choice",
      "For this accuracy on this kind of scene take this",
      "The method that is the fastest there, or not apart from the fastest by more than the noise of the times, "
      "on most of the scenes.",
      {"scenes", "quantity", "accuracy", "method", "on", "of"}};
  for (std::size_t kind = 0; kind < kSceneKinds.size(); ++kind)
    for (std::size_t quantity = 0; quantity < kQuantities.size(); ++quantity)
      for (const double accuracy : kAccuracies) {
        std::map<std::string, int> wins;
        int reached = 0;
        for (const SceneChart& chart : charts) {
          if (kind_of(chart) != kind || accuracy < kResolved * chart.agreement[quantity]) continue;
          const CostCurves curves(chart.rows, quantity, chart.agreement[quantity]);
          const Standing standing = curves.at(accuracy);
          reached += !standing.order.empty();
          for (std::size_t k = 0; k < standing.alike; ++k) ++wins[curves.all()[standing.order[k].curve].method];
        }
        const auto most = std::ranges::max_element(wins, {}, [](const auto& win) { return win.second; });
        if (most == wins.end()) continue;
        table.rows.push_back({std::string(kSceneKinds[kind]), std::string(kQuantities[quantity]),
                              fmt::format("1e-{}", std::lround(-std::log10(accuracy))), most->first,
                              std::to_string(most->second), std::to_string(reached)});
      }
  return table;
}

PanelPlot fronts_plot(const std::vector<SceneChart>& charts) {
  PanelPlot plot{.file = "fronts_plot",
                 .title = "Time against the error in positions",
                 .x = "error in position   (← more accurate)",
                 .y = "time, s",
                 .columns = 4,
                 .shared = false};
  for (const SceneChart& chart : charts) {
    std::map<std::string, std::vector<ChartRow>> by_integrator;  // all formulations as one method
    for (ChartRow row : chart.rows) {
      row.formulation.clear();
      row.linear_solver.clear();
      by_integrator[row.integrator].push_back(row);
    }
    for (const auto& [integrator, rows] : by_integrator)
      for (const CostCurve& curve : cost_curves(rows, 0, chart.agreement[0])) {
        Curve drawn{chart.scene, integrator, ""};
        for (const CostCurve::Knot& knot : curve.knots)
          if (knot.error <= 1) drawn.points.push_back({knot.error, knot.seconds});
        if (!drawn.points.empty()) plot.curves.push_back(std::move(drawn));
      }
  }
  return plot;
}

}  // namespace poinsot::study
