#include "bench/study/scale_series.h"

#include <fmt/format.h>

#include <algorithm>
#include <optional>

#include "bench/study/fit.h"
#include "bench/study/measure.h"
#include "core/interruption.h"

namespace poinsot::study {
namespace {

struct Quantity {
  const char* column;  // of the cost table
  const char* panel;   // of the plot
  double IsolatedRun::*figure;
  bool per_body;
  int from = 100;  // bodies from which a power is fitted; below, what a run costs at any size weighs in
};
constexpr const char* kIntegrator = "implicit_euler";
constexpr Quantity kMeasured[] = {
    {"us/body", "step, µs per body and iteration", &IsolatedRun::us_per_body, true},
    {"assembly", "assembly, µs per body and iteration", &IsolatedRun::assembly, true},
    {"factor", "factorization, µs per body and iteration", &IsolatedRun::factor, true},
    {"solve", "solves, µs per body and iteration", &IsolatedRun::solve, true},
    {"rest", "the rest, µs per body and iteration", &IsolatedRun::rest, true},
    {"kB/body", "memory, kB per body", &IsolatedRun::kilobytes_per_body, true, 1000},  // that is megabytes
    {"start s", "start-up, s", &IsolatedRun::start, false},
};

double median(const std::vector<IsolatedRun>& runs, double IsolatedRun::*figure) {
  std::vector<double> values;
  for (const IsolatedRun& run : runs) values.push_back(run.*figure);
  return timing(values).median;
}

// Over the number of bodies; 0 cannot be drawn or fitted and is left out.
std::vector<Point> points(const Series& series, const Quantity& quantity) {
  std::vector<Point> all;
  for (const auto& runs : series.runs) {
    if (!good(runs)) continue;
    const int bodies = runs.front().bodies;
    if (const double value = median(runs, quantity.figure); value > 0)
      all.push_back({static_cast<double>(bodies), value, bodies >= quantity.from});
  }
  return all;
}

// Of the whole (per body times bodies) over the number of bodies.
std::optional<double> exponent(const Series& series, const Quantity& quantity) {
  std::vector<double> x, y;
  for (const Point& point : points(series, quantity)) {
    if (!point.in_fit) continue;
    x.push_back(point.x);
    y.push_back(quantity.per_body ? point.x * point.y : point.y);
  }
  if (x.size() < 2) return std::nullopt;
  return fit_power(x, y).exponent;
}

std::vector<std::string> names(const Series& series) {
  return {std::string(series.structure->name), series.settings.formulation, series.settings.linear_solver};
}

// A series ends where ten times the bodies would take longer than this at the same cost per body.
constexpr double kLongestOfSize = 60;  // s

bool take_too_long(const std::vector<IsolatedRun>& runs) {
  return good(runs) && 10 * runs.front().seconds > kLongestOfSize;
}

// Few steps where a step is long: about as much work for every size, 20 to 200 steps after the first ten. Fewer would
// be less than what two runs differ by in their starts.
double end_of(int bodies, double step) {
  return step * (kUntimedSteps + std::clamp(20000 / bodies, 20, 200));
}

constexpr std::string_view kLeftOut = "left out";

}  // namespace

bool good(const std::vector<IsolatedRun>& runs) {
  return !runs.empty() && runs.front().failure.empty();
}

Table cost_table(const std::vector<Series>& all) {
  Table table{
      "scaling",
      "Cost per body and Newton iteration",
      "Implicit Euler, exact Newton matrix; microseconds per body and iteration, the whole step and by phase, "
      "from the eleventh step on; kilobytes resident per body; seconds that a run takes beyond its iterations: in "
      "the first steps the linear solver chooses its pivots and examines its solutions.",
      {"structure", "formulation", "linear solver", "bodies"}};
  for (const Quantity& quantity : kMeasured) table.header.emplace_back(quantity.column);
  for (const Series& series : all) {
    for (const auto& runs : series.runs) {
      if (!good(runs)) continue;
      std::vector<std::string> row = names(series);
      row.push_back(std::to_string(runs.front().bodies));
      for (const Quantity& quantity : kMeasured) row.push_back(fmt::format("{:.3f}", median(runs, quantity.figure)));
      table.rows.push_back(row);
    }
  }
  return table;
}

Table growth_table(const std::vector<Series>& all) {
  Table table{
      "growth",
      "Growth",
      "Exponents of the number of bodies, fitted by least squares in logarithms, of the time of an iteration, the "
      "whole and by phase, and of the start-up time, from 100 bodies on, and of the resident memory, from 1000 "
      "on: 1 is linear. Last, the cost per body of the largest scene over that of the smallest one fitted.",
      {"structure", "formulation", "linear solver", "step", "assembly", "factor", "solve", "rest", "memory", "start-up",
       "from bodies", "to bodies", "largest / smallest"}};
  for (const Series& series : all) {
    if (!exponent(series, kMeasured[0])) continue;
    std::vector<std::string> row = names(series);
    for (const Quantity& quantity : kMeasured) {
      const std::optional<double> fitted = exponent(series, quantity);
      row.push_back(fitted ? fmt::format("{:.3f}", *fitted) : "-");
    }
    std::vector<Point> fitted = points(series, kMeasured[0]);
    std::erase_if(fitted, [](const Point& point) { return !point.in_fit; });
    row.push_back(fmt::format("{:g}", fitted.front().x));
    row.push_back(fmt::format("{:g}", fitted.back().x));
    row.push_back(fmt::format("{:.2f}", fitted.back().y / fitted.front().y));
    table.rows.push_back(std::move(row));
  }
  if (table.rows.empty()) table.text = "No series has two sizes from 100 bodies on, which an exponent takes.";
  return table;
}

PanelPlot scaling_plot(const std::vector<Series>& all) {
  PanelPlot plot{"scaling_plot", "Cost over the number of bodies: implicit Euler, exact Newton matrix", "bodies", ""};
  plot.columns = 4;
  plot.shared = false;  // their units differ
  for (const Quantity& quantity : kMeasured) {
    for (const Series& series : all)
      plot.curves.push_back({quantity.panel, std::string(series.structure->name),
                             fmt::format("{}, {}", series.settings.formulation, series.settings.linear_solver),
                             points(series, quantity)});
  }
  return plot;
}

std::vector<Series> measure_scale(const ScaleRequest& request, const ProgressCallback& progress) {
  std::vector<int> all_sizes;
  for (int n = 1; n <= request.most; n *= 10) all_sizes.push_back(n);
  std::vector<Series> all;
  for (const SceneGenerator& structure : scene_generators())
    for (const std::string& formulation : request.formulations)
      for (const std::string& solver : request.linear_solvers) {
        Series series{&structure, {}, all_sizes, std::vector<std::vector<IsolatedRun>>(all_sizes.size())};
        series.settings.integrator = kIntegrator;
        series.settings.formulation = formulation;
        series.settings.linear_solver = solver;
        all.push_back(series);
      }
  const std::size_t runs = all.size() * all_sizes.size();
  RunCounter counter(runs * static_cast<std::size_t>(request.repetitions), progress);
  in_turn(runs, {request.repetitions, false, [&](std::size_t) { counter.next(); }}, [&](std::size_t k, int round) {
    const std::size_t n = k / all.size();  // of all structures the small ones first
    Series& series = all[k % all.size()];
    auto& of_size = series.runs[n];
    if (round > 0 && !good(of_size)) return;
    if (n > 0 && take_too_long(series.runs[n - 1])) {
      const IsolatedRun& before = series.runs[n - 1].front();
      of_size.push_back({{}, fmt::format("{}, {} bodies took {:.0f} s", kLeftOut, before.bodies, before.seconds)});
      return;
    }
    series.settings.end = series.settings.every = end_of(all_sizes[n], series.settings.step);
    const IsolatedRun run = run_isolated(*series.structure, all_sizes[n], series.settings);
    if (!interruption_requested) of_size.push_back(run);
  });
  return all;
}

std::vector<Missing> missing(const std::vector<Series>& all) {
  std::vector<Missing> sentences;
  for (const Series& series : all)
    for (std::size_t n = 0; n < series.sizes.size(); ++n) {
      if (series.runs[n].empty() || good(series.runs[n])) continue;  // empty: it did not come to that
      const std::string& why = series.runs[n].front().failure;
      sentences.push_back(
          {fmt::format("no figure for {} of {} bodies, {}, {}: {}", series.structure->name, series.sizes[n],
                       series.settings.formulation, series.settings.linear_solver, why),
           !why.starts_with(kLeftOut)});
    }
  return sentences;
}

Report scale_report(const std::vector<Series>& all, int repetitions, int core) {
  Report report{"Scaling",
                "Chains, trees, ladders of closed loops and the N-four-bar, each run in its own process.",
                {cost_table(all), growth_table(all)},
                origin_lines(core)};
  report.foot.push_back(
      fmt::format("settings: {}, h = {:g} s, tolerance {:g}, jacobian {}; {} interleaved "
                  "repetitions, median",
                  kIntegrator, Settings{}.step, Settings{}.tolerance, Settings{}.jacobian, repetitions));
  return report;
}

}  // namespace poinsot::study
