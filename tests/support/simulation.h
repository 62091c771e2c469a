// Scenes run and kept: models by name, snapshots of a run, how far two motions are apart, slopes of convergence,
// tables.
#pragma once

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <sstream>
#include <string>
#include <string_view>
#include <vector>

#include "bench/study/motion.h"
#include "core/check.h"
#include "core/scene_reader.h"
#include "formulations/registry.h"
#include "integrators/jacobian_policy.h"
#include "integrators/simulate.h"
#include "linsolve/registry.h"

namespace poinsot::test {

inline Scene scene_of(std::string_view model) {
  return read_scene(fmt::format("{}/models/{}.json", POINSOT_SOURCE_DIR, model));
}

// Of models/, in order of name.
inline std::vector<std::string> model_names() {
  std::vector<std::string> names;
  for (const auto& entry : std::filesystem::directory_iterator(POINSOT_SOURCE_DIR "/models")) {
    const std::string file = entry.path().filename().string();
    if (file.ends_with(".json") && !file.ends_with(".schema.json")) names.push_back(entry.path().stem().string());
  }
  std::ranges::sort(names);
  return names;
}

// The motion at one instant; of a run also the multipliers, by row of the problem.
struct Snapshot {
  double t = 0;
  std::vector<BodyState> bodies;
  std::vector<double> lambda;
};

inline constexpr std::array kQuantities{"positions", "velocities", "accelerations", "multipliers"};

struct Recorded {
  Outcome outcome;
  std::vector<Snapshot> samples;
};

inline Snapshot snapshot(const Sample& sample) {
  Snapshot s{sample.t, std::vector<BodyState>(static_cast<std::size_t>(sample.problem.bodies())),
             std::vector<double>(sample.lambda.begin(), sample.lambda.end())};
  sample.problem.to_bodies(sample.a, s.bodies);
  return s;
}

inline Recorded run(const Scene& scene, const Settings& settings) {
  Recorded r;
  r.outcome = simulate(scene, settings, [&](const Sample& sample) { r.samples.push_back(snapshot(sample)); });
  return r;
}

// A run that has to come to its end.
inline std::vector<Snapshot> motion(const Scene& scene, const Settings& settings) {
  Recorded r = run(scene, settings);
  EXPECT_TRUE(r.outcome.status.ok()) << settings.formulation << ' ' << settings.jacobian << ": "
                                     << r.outcome.status.message;
  return std::move(r.samples);
}

inline Settings kinematics(std::string_view formulation, double step, double end, double every = 0) {
  Settings s;
  s.analysis = Analysis::kinematics;
  s.formulation = formulation;
  s.step = step;
  s.end = end;
  s.every = every;
  s.tolerance = 1e-12;
  return s;
}

// Implicit Euler. Newton's method is driven to where its corrections move positions by 1e-11 m.
inline Settings dynamics(std::string_view formulation, double step, double end, double every = 0) {
  Settings s;
  s.integrator = "implicit_euler";
  s.formulation = formulation;
  s.step = step;
  s.end = end;
  s.every = every;
  s.stopping = "correction";
  s.tolerance = 1e-11 / (step * step);
  s.max_iterations = 100;  // for the simplified matrix
  return s;
}

// Integrators with error control.
inline Settings controlled(std::string_view integrator, std::string_view formulation, double rtol, double end,
                           double every = 0) {
  Settings s;
  s.integrator = integrator;
  s.formulation = formulation;
  s.rtol = rtol;
  s.end = end;
  s.every = every;
  return s;
}

// How far two motions are apart at the same instants, by kind and relative to the second one: bench/study/motion.h.
struct Distance : study::BodyDifference {
  double largest() const { return std::max({r, A, rd, w, rdd, wd}); }
};

inline std::ostream& operator<<(std::ostream& out, const Distance& d) {
  return out << fmt::format("r {:.2g}, A {:.2g}, velocity {:.2g} {:.2g}, acceleration {:.2g} {:.2g}", d.r, d.A, d.rd,
                            d.w, d.rdd, d.wd);
}

inline study::Motion motion_of(const std::vector<Snapshot>& samples) {
  study::Motion motion;
  for (const Snapshot& sample : samples) {
    motion.t.push_back(sample.t);
    motion.bodies.push_back(sample.bodies);
  }
  return motion;
}

inline Distance distance(const std::vector<Snapshot>& x, const std::vector<Snapshot>& reference) {
  check(x.size() == reference.size() && !x.empty(), "two motions have the same instants");
  for (std::size_t n = 0; n < x.size(); ++n)
    check(std::abs(x[n].t - reference[n].t) < 1e-12 * (1 + std::abs(x[n].t)), "two motions have the same instants");
  const study::Motion from = motion_of(reference);
  Distance d{study::body_difference(motion_of(x), from, study::body_sizes(from))};
  for (double* part : {&d.r, &d.A, &d.rd, &d.w, &d.rdd, &d.wd})
    if (std::isnan(*part)) *part = INFINITY;  // no maximum loses it
  return d;
}

// The slope of log(error) over log(step), fitted and between every two neighbours, is `order` to `within`.
inline ::testing::AssertionResult converges(const std::vector<double>& steps, const std::vector<double>& errors,
                                            double order = 1, double within = 0.1) {
  check(steps.size() >= 5 && steps.size() == errors.size(), "an order takes five steps or more");
  const auto n = static_cast<double>(steps.size());
  double sx = 0, sy = 0, sxx = 0, sxy = 0, worst = 0;
  std::vector<double> slopes;
  for (std::size_t k = 0; k < steps.size(); ++k) {
    const double x = std::log(steps[k]), y = std::log(errors[k]);
    sx += x, sy += y, sxx += x * x, sxy += x * y;
    if (k > 0) slopes.push_back((y - std::log(errors[k - 1])) / (x - std::log(steps[k - 1])));
  }
  slopes.push_back((n * sxy - sx * sy) / (n * sxx - sx * sx));
  for (double slope : slopes) worst = std::isfinite(slope) ? std::max(worst, std::abs(slope - order)) : INFINITY;
  auto result = worst <= within ? ::testing::AssertionSuccess() : ::testing::AssertionFailure();
  return result << fmt::format("order {}: slopes of neighbours {:.3f}, fitted {:.3f}; errors {:.3g}", order,
                               fmt::join(slopes.begin(), slopes.end() - 1, " "), slopes.back(), fmt::join(errors, " "));
}

// A table of tests/reference: the header and the cells, as text.
struct Table {
  std::vector<std::string> header;
  std::vector<std::vector<std::string>> rows;
};

inline Table reference_table(std::string_view name) {
  std::ifstream in(fmt::format("{}/tests/reference/{}.csv", POINSOT_SOURCE_DIR, name));
  check(in.good(), "the reference table is there");
  Table table;
  for (std::string line; std::getline(in, line);) {
    std::vector<std::string> cells;
    std::istringstream text(line);
    for (std::string cell; std::getline(text, cell, ',');) cells.push_back(cell);
    if (table.header.empty()) {
      table.header = cells;
    } else {
      table.rows.push_back(cells);
    }
  }
  return table;
}

// t, body, r, A by rows, v, w, a, al: a motion of the reference.
inline std::vector<Snapshot> reference_motion(std::string_view name) {
  std::vector<Snapshot> samples;
  for (const std::vector<std::string>& row : reference_table(name).rows) {
    std::vector<double> x;
    for (const std::string& cell : row) x.push_back(std::stod(cell));
    check(x.size() == 26, "a row of a motion has 26 columns");
    if (x[1] == 1) samples.push_back({x[0], {}, {}});
    const auto vector = [&](int at) { return Vector3(Eigen::Map<const Vector3>(x.data() + at)); };
    BodyState state;
    state.r = vector(2);
    state.A = Eigen::Map<const Eigen::Matrix<double, 3, 3, Eigen::RowMajor>>(x.data() + 5);
    state.rd = vector(14), state.w = vector(17);
    state.rdd = vector(20), state.wd = vector(23);
    samples.back().bodies.push_back(state);
  }
  return samples;
}

inline std::vector<std::string> formulation_names() {
  std::vector<std::string> names;
  for (const FormulationEntry& entry : formulations()) names.emplace_back(entry.name);
  return names;
}
inline std::vector<std::string> jacobian_names() {
  std::vector<std::string> names;
  for (const JacobianEntry& entry : jacobians()) names.emplace_back(entry.name);
  return names;
}

}  // namespace poinsot::test
