// The paper's two figures of iterations: Newton iterations a step over the step size, four link, 3 s, in kinematics
// (stopped at 1e-11) and in dynamics (stopped at Θ with Θ h² = 1e-11); beside the simplified matrix of the original
// codes also the exact one.
#include <fmt/format.h>

#include "bench/paper/cell_rows.h"
#include "bench/paper/figure.h"
#include "bench/paper/published.h"
#include "bench/study/progress.h"
#include "bench/study/range.h"
#include "formulations/registry.h"
#include "integrators/simulate.h"

namespace poinsot::paper {
using namespace study;
namespace {

constexpr double kThetaPosition = 1e-11;  // m, the paper's accuracy of positions

// Iterations a step; 0 and a sentence where the run fails.
double average(const Scene& scene, const Settings& settings, FigureResult& result) {
  const Outcome outcome = simulate(scene, settings, {});
  if (outcome.status.ok())
    return static_cast<double>(outcome.statistics.newton_iterations) / static_cast<double>(outcome.statistics.steps);
  result.failures.push_back(fmt::format("{}, {}, {}, h = {:g} s: {}", analysis_name(settings.analysis),
                                        settings.formulation, settings.jacobian, settings.step,
                                        outcome.status.message));
  return 0;
}

Settings settings_of(Analysis analysis, std::string_view jacobian, std::string_view formulation, double step,
                     double end) {
  Settings settings;
  settings.analysis = analysis;
  settings.integrator = "implicit_euler";
  settings.retry = false;
  settings.jacobian = jacobian;
  settings.stopping = "correction";
  settings.formulation = formulation;
  settings.step = step;
  settings.end = settings.every = end;
  settings.tolerance = analysis == Analysis::kinematics ? kThetaPosition : kThetaPosition / (step * step);
  settings.max_iterations = 50;
  return settings;
}

// Ours over 1 s beside what the original codes need for it, dynamics with the simplified matrix.
Table beside_original(const Scene& scene, FigureResult& result) {
  Table table{"iterations_original",
              "Iterations a step beside the original codes",
              "Four link, dynamics, simplified matrix, 1 s, steps of exact length: ours, and the original codes run "
              "again with such steps. Theirs needs more in rp because its residual holds the gradient p of the "
              "normalizations at the old position.",
              {"formulation", "h, s", "ours", "original"}};
  for (const OriginalIterations& theirs : original_iterations()) {
    const double ours =
        average(scene, settings_of(Analysis::dynamics, "simplified", theirs.formulation, theirs.step, 1), result);
    table.rows.push_back({std::string(theirs.formulation), fmt::format("{:g}", theirs.step),
                          fmt::format("{:.2f}", ours), fmt::format("{:.2f}", theirs.iterations)});
  }
  return table;
}

}  // namespace

FigureResult iterations(const FigureRequest& request) {
  const Scene scene = request.scene("four_link");
  const double end = request.quick ? 0.48 : 3;
  std::vector<double> steps{2e-2, 1e-2, 8e-3, 4e-3, 2e-3, 1e-3};  // the original study's
  if (!request.quick) steps.insert(steps.end(), {5e-4, 2e-4, 1e-4});

  FigureResult result;
  PanelPlot plot{"iterations", fmt::format("Newton iterations a step, four link, {:g} s", end), "step size h, s",
                 "iterations a step"};
  plot.log_y = false;
  Table table{"iterations_table",
              "Newton iterations a step",
              "Four link; kinematics stopped where the correction is below 1e-11, dynamics (implicit Euler) where that "
              "of accelerations and multipliers is below Θ with Θ h² = 1e-11.",
              {"analysis", "jacobian", "h, s"}};
  for (const FormulationEntry& formulation : formulations()) table.header.emplace_back(formulation.name);

  RunCounter counter(4 * formulations().size() * steps.size(), request.progress);
  for (const Analysis analysis : {Analysis::kinematics, Analysis::dynamics}) {
    for (const char* jacobian : {"exact", "simplified"}) {
      std::vector<Curve> curves;
      for (const FormulationEntry& formulation : formulations())
        curves.push_back({fmt::format("{}, {}", analysis_name(analysis), jacobian), std::string(formulation.name),
                          std::string(formulation.name)});
      for (const double step : steps) {
        std::vector<std::string> row{std::string(analysis_name(analysis)), jacobian, fmt::format("{:g}", step)};
        for (Curve& curve : curves) {
          counter.next();
          const double found = average(scene, settings_of(analysis, jacobian, curve.series, step, end), result);
          if (found > 0) curve.points.push_back({step, found});
          row.push_back(found > 0 ? fmt::format("{:.3f}", found) : "");
        }
        table.rows.push_back(std::move(row));
      }
      Range range;
      for (const Curve& curve : curves)
        for (const Point& point : curve.points) range.add(point.y);
      if (!range.empty())
        result.summary.push_back(
            fmt::format("{}, {}: {} iterations a step", analysis_name(analysis), jacobian, range.text(2)));
      plot.curves.insert(plot.curves.end(), curves.begin(), curves.end());
    }
  }
  result.plots.push_back(std::move(plot));
  result.tables = {table, beside_original(scene, result)};
  return result;
}

}  // namespace poinsot::paper
