// The paper's figure of the double pendulum: Δz = z of the reference − z of body 2 over 5 s, implicit Euler at h =
// 1e-2, 1e-3 and 1e-4 in each formulation; and how far the formulations are from one another.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <iterator>

#include "bench/paper/figure.h"
#include "bench/study/progress.h"
#include "formulations/registry.h"
#include "integrators/simulate.h"

namespace poinsot::paper {
using namespace study;
namespace {

constexpr double kBetweenPoints = 0.01;          // s between points
constexpr std::size_t kSecond = 101;             // points of the first second
constexpr std::size_t kBody = 1;                 // body 2 of the paper
constexpr double kSteps[] = {1e-2, 1e-3, 1e-4};  // the paper's

// z of body 2 at the points; empty, and a sentence, where the run fails.
std::vector<double> heights(const Scene& scene, const Settings& settings, FigureResult& result) {
  std::vector<double> z;
  std::vector<BodyState> bodies(scene.bodies.size());
  const Outcome outcome = simulate(scene, settings, [&](const Sample& sample) {
    sample.problem.to_bodies(sample.a, bodies);
    z.push_back(bodies[kBody].r.z());
  });
  if (outcome.status.ok()) return z;
  result.failures.push_back(fmt::format("double pendulum, {}, {}, h = {:g} s: {}", settings.integrator,
                                        settings.formulation, settings.step, outcome.status.message));
  return {};
}

std::vector<Point> difference(const std::vector<double>& x, const std::vector<double>& y) {
  std::vector<Point> points;
  for (std::size_t n = 0; n < std::min(x.size(), y.size()); ++n)
    points.push_back({static_cast<double>(n) * kBetweenPoints, x[n] - y[n]});
  return points;
}

double apart(const std::vector<double>& x, const std::vector<double>& y, std::size_t count) {
  double most = 0;
  for (std::size_t n = 0; n < std::min({count, x.size(), y.size()}); ++n) most = std::max(most, std::abs(x[n] - y[n]));
  return most;
}

}  // namespace

FigureResult solution_deltas(const FigureRequest& request) {
  const Scene scene = request.scene("double_pendulum");
  FigureResult result;
  Settings settings;
  settings.end = request.quick ? 2 : 5;
  settings.every = kBetweenPoints;
  settings.rtol = 1e-13;
  settings.atol = 1e-14;
  settings.integrator = "dop853";
  const std::vector<double> reference = heights(scene, settings, result);

  PanelPlot plot{"solution_deltas",
                 "Double pendulum, implicit Euler: Δz of body 2 from the reference and between formulations", "t, s",
                 "Δz, m"};
  plot.log_x = plot.log_y = false;
  plot.columns = 1;
  Table table{
      "solution_deltas_table",
      "Double pendulum: Δz of body 2 from the reference",
      fmt::format("Implicit Euler; the reference is dop853 at rtol {:g}. Largest |Δz| over the first second and "
                  "over {:g} s, each with its exponent of h from the step above; and how far z is from that of "
                  "rA at the same step in the first second, in % of rA's largest |Δz| there.",
                  settings.rtol, settings.end),
      {"formulation", "h, s", "to 1 s, m", "exponent", fmt::format("to {:g} s, m", settings.end), "exponent (all)",
       "from rA, %"}};
  RunCounter counter(formulations().size() * std::size(kSteps), request.progress);
  std::vector<std::vector<double>> first;  // by step, of the first formulation: rA
  std::vector<Curve> between;              // of the others from it
  settings.integrator = "implicit_euler";
  settings.retry = false;
  settings.stopping = "correction";
  for (const FormulationEntry& formulation : formulations()) {
    settings.formulation = formulation.name;
    double above[2] = {};
    for (std::size_t s = 0; s < std::size(kSteps); ++s) {
      counter.next();
      settings.step = kSteps[s];
      settings.tolerance = 1e-11 / (kSteps[s] * kSteps[s]);  // the paper's Θ
      const std::vector<double> z = heights(scene, settings, result);
      if (first.size() == s) first.push_back(z);
      const std::string series = fmt::format("h = {:g} s", kSteps[s]);
      plot.curves.push_back({std::string(formulation.name), series, "", difference(reference, z)});
      if (&formulation != &formulations().front())
        between.push_back({fmt::format("z of {} − z of {}", formulations().front().name, formulation.name), series, "",
                           difference(first[s], z)});

      const double here[] = {apart(z, reference, kSecond), apart(z, reference, z.size())};
      std::vector<std::string> row{std::string(formulation.name), fmt::format("{:g}", kSteps[s])};
      for (int k = 0; k < 2; ++k) {
        row.push_back(fmt::format("{:.3e}", here[k]));
        row.push_back(
            s == 0 ? "" : fmt::format("{:.3f}", std::log(above[k] / here[k]) / std::log(kSteps[s - 1] / kSteps[s])));
        above[k] = here[k];
      }
      row.push_back(fmt::format("{:.2g}", 100 * apart(z, first[s], kSecond) / apart(first[s], reference, kSecond)));
      result.summary.push_back(fmt::format("{}, {}: at most {:.3e} m in the first second, {:.3e} m in all",
                                           formulation.name, series, here[0], here[1]));
      table.rows.push_back(std::move(row));
    }
  }
  plot.curves.insert(plot.curves.end(), between.begin(), between.end());
  result.plots.push_back(std::move(plot));
  result.tables.push_back(std::move(table));
  return result;
}

}  // namespace poinsot::paper
