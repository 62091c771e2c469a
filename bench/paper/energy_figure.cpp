// Energy of the free double pendulum over 1000 s, fixed step h = 1e-2: RATTLE's error stays within bounds, implicit
// Euler and generalized-α lose energy. E − E(0) by intervals: least, mean and largest value of all steps in each, so
// that nothing is lost between the points drawn.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "bench/paper/figure.h"
#include "bench/study/fit.h"
#include "bench/study/progress.h"
#include "formulations/registry.h"
#include "integrators/simulate.h"

namespace poinsot::paper {
using namespace study;
namespace {

constexpr double kEnergyStep = 0.01;  // s

struct Interval {
  double low = std::numeric_limits<double>::infinity(), high = -low, sum = 0;
  int count = 0;

  void add(double value) {
    low = std::min(low, value);
    high = std::max(high, value);
    sum += value;
    ++count;
  }
  double mean() const { return sum / count; }
};

struct EnergyCourse {
  double start = 0;  // E(0)
  double last = 0;   // E − E(0) at the end
  std::vector<Interval> intervals;
  std::string failure;
};

EnergyCourse energy_course(const Scene& scene, const Settings& settings, double interval) {
  EnergyCourse course;
  const Outcome outcome = simulate(scene, settings, [&](const Sample& sample) {
    const double energy = sample.problem.energy();
    if (sample.t == 0) {
      course.start = energy;
      return;
    }
    const double gone = std::ceil(sample.t / interval - 1e-9);  // an interval holds its end, not its beginning
    course.intervals.resize(static_cast<std::size_t>(gone));
    course.intervals.back().add(energy - course.start);
    course.last = energy - course.start;
  });
  if (!outcome.status.ok()) course.failure = outcome.status.message;
  return course;
}

double largest(std::span<const Interval> intervals) {
  double most = 0;
  for (const Interval& interval : intervals) most = std::max({most, interval.high, -interval.low});
  return most;
}

// What loses less is hidden beside what loses more.
constexpr const char* kAll = "all, rA";
constexpr const char* kClose = "without implicit Euler, rA";
constexpr const char* kRattle = "rattle, all formulations";

}  // namespace

FigureResult energy(const FigureRequest& request) {
  const Scene scene = request.scene("double_pendulum");
  const double end = request.quick ? 100 : 1000, interval = end / 200;
  FigureResult result;
  PanelPlot plot{"energy", fmt::format("Double pendulum, h = {:g} s: energy over {:g} s", kEnergyStep, end), "t, s",
                 "E − E(0), J"};
  plot.log_x = plot.log_y = false;
  plot.bands = true;
  plot.columns = 1;
  Table table{"energy_table",
              "Energy of the free double pendulum",
              "",
              {"integrator", "formulation", "E(end) − E(0), J", "largest, first half, J", "largest, second half, J",
               "trend, J", "trend, % of the largest"}};
  std::vector<std::pair<const IntegratorEntry*, const FormulationEntry*>> runs;
  for (const IntegratorEntry& integrator : integrators()) {
    if (integrator.analysis != Analysis::dynamics || integrator.controls_error) continue;
    for (const FormulationEntry& formulation : formulations()) runs.emplace_back(&integrator, &formulation);
  }
  RunCounter counter(runs.size(), request.progress);
  double start = 0;
  std::vector<Curve> close, rattle;
  for (const auto& [integrator, formulation] : runs) {
    counter.next();
    Settings settings;
    settings.integrator = integrator->name;
    settings.formulation = formulation->name;
    settings.step = kEnergyStep;
    settings.end = end;
    settings.tolerance = 1e-8;  // of accelerations: the integrator is seen, not Newton's method
    const EnergyCourse course = energy_course(scene, settings, interval);
    if (!course.failure.empty()) {
      result.failures.push_back(fmt::format("{}, {}: {}", integrator->name, formulation->name, course.failure));
      continue;
    }
    start = course.start;
    std::vector<double> t, mean;
    std::vector<Point> points;
    for (std::size_t k = 0; k < course.intervals.size(); ++k) {
      const Interval& part = course.intervals[k];
      t.push_back((static_cast<double>(k) + 0.5) * interval);
      mean.push_back(part.mean());
      points.push_back({t.back(), mean.back(), false, part.low, part.high});
    }
    const double trend = fit_line(t, mean).slope * end;
    const std::span<const Interval> all = course.intervals;
    const double first = largest(all.first(all.size() / 2)), second = largest(all.subspan(all.size() / 2));
    table.rows.push_back({std::string(integrator->name), std::string(formulation->name),
                          fmt::format("{:.2f}", course.last), fmt::format("{:.2f}", first),
                          fmt::format("{:.2f}", second), fmt::format("{:.2f}", trend),
                          fmt::format("{:.1f}", 100 * trend / std::max(first, second))});
    const std::string name(integrator->name);
    result.summary.push_back(fmt::format("{}, {}: E - E(0) is {:.2f} J at the end, {:.2f} J at most, trend {:.2f} J",
                                         name, formulation->name, course.last, std::max(first, second), trend));
    if (formulation->name == "rA") {
      plot.curves.push_back({kAll, name, "", points});
      if (name != "implicit_euler") close.push_back({kClose, name, "", points});
    }
    if (name == "rattle") rattle.push_back({kRattle, std::string(formulation->name), "", points});
  }
  for (auto* panel : {&close, &rattle}) plot.curves.insert(plot.curves.end(), panel->begin(), panel->end());
  table.text = fmt::format(
      "h = {:g} s over {:g} s; E(0) = {:.2f} J. The trend is the change over the whole time of a straight line fitted "
      "to "
      "the means over {:g} s. The motion is chaotic: a few per cent of trend either way come from where it happens to "
      "be.",
      kEnergyStep, end, start, interval);
  result.plots.push_back(std::move(plot));
  result.tables.push_back(std::move(table));
  return result;
}

}  // namespace poinsot::paper
