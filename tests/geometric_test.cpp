// Integrators of fixed step: orders of every quantity. Of generalized-α, RATTLE and half-implicit Euler also: starts
// without order reduction, what RATTLE keeps over long runs, symmetry, changes of chart, failures.
//
// The reference is dop853 at its tightest tolerance, whose own digits the tests of the benchmark problems hold.
#include <gmock/gmock.h>

#include <array>
#include <map>
#include <numeric>

#include "core/input_error.h"
#include "tests/support/forced_scene.h"
#include "tests/support/simulation.h"

namespace poinsot::test {
namespace {

using ::testing::HasSubstr;

struct Method {
  std::string name;
  double order;
};
const std::vector<Method> kSecondOrder{{"generalized_alpha", 2}, {"generalized_alpha_i2", 2}, {"rattle", 2}};

// All of the registry, with the orders stated there.
std::vector<Method> fixed_step_methods() {
  std::vector<Method> methods;
  for (const IntegratorEntry& entry : integrators()) {
    if (entry.analysis == Analysis::dynamics && !entry.controls_error) {
      methods.push_back({std::string(entry.name), static_cast<double>(entry.order)});
    }
  }
  return methods;
}

// A case of the order tests; `turning` sets off, because from rest some errors cancel.
struct Case {
  std::string name;
  Scene scene;
  double end, step;  // step: the largest; the end is 8 n steps
};

Scene turning(std::string_view model, const Vector3& w) {
  Scene scene = scene_of(model);
  for (Body& body : scene.bodies) body.angular_velocity = w;  // velocities are projected onto the constraints
  return scene;
}

// The fast top turns so evenly in reps' angles that the errors of accelerations drown in the rounding that Φ/h²
// magnifies; its changes of chart have a test of their own.
std::vector<Case> cases(std::string_view formulation) {
  std::vector<Case> all{{"single_pendulum", scene_of("single_pendulum"), 0.8, 0.01},
                        {"free pendulum", turning("single_pendulum_free", {0, 0, 1}), 0.8, 0.01},
                        {"slider_crank", scene_of("slider_crank"), 0.4, 0.005},
                        {"four_link", scene_of("four_link"), 0.8, 0.005},
                        {"double_pendulum", turning("double_pendulum", {0, 0, 1}), 0.8, 0.01},
                        {"slow top", turning("heavy_top", {2.6, -4.2, 1.4}), 0.4, 0.005},
                        {"forced", forced(), 0.8, 0.01}};
  if (formulation != "reps") all.push_back({"heavy_top", scene_of("heavy_top"), 0.04, 2.5e-4});
  return all;
}

Settings settings_of(std::string_view integrator, std::string_view formulation, double step, double end, double every) {
  Settings s = dynamics(formulation, step, end, every);
  s.integrator = integrator;
  s.tolerance = 1e-9;  // rounding ends the iteration where this is less
  return s;
}

std::vector<Snapshot> reference(const Scene& scene, double step, double end, double every) {
  Settings s = settings_of("dop853", "rA", step, end, every);
  s.rtol = 1e-13;
  s.atol = 1e-14;
  return motion(scene, s);
}

// Largest errors of positions, velocities, accelerations and multipliers.
using Errors = std::array<double, 4>;

Errors absolute_errors(const Snapshot& x, const Snapshot& exact) {
  Errors e{};
  for (std::size_t b = 0; b < exact.bodies.size(); ++b) {
    const BodyState &u = x.bodies[b], &v = exact.bodies[b];
    e[0] = std::max({e[0], (u.r - v.r).cwiseAbs().maxCoeff(), (u.A - v.A).cwiseAbs().maxCoeff()});
    e[1] = std::max({e[1], (u.rd - v.rd).cwiseAbs().maxCoeff(), (u.w - v.w).cwiseAbs().maxCoeff()});
    e[2] = std::max({e[2], (u.rdd - v.rdd).cwiseAbs().maxCoeff(), (u.wd - v.wd).cwiseAbs().maxCoeff()});
  }
  for (std::size_t k = 0; k < exact.lambda.size(); ++k) e[3] = std::max(e[3], std::abs(x.lambda[k] - exact.lambda[k]));
  return e;
}

// Relative to the largest values.
Errors errors(const std::vector<Snapshot>& x, const std::vector<Snapshot>& exact) {
  const Distance d = distance(x, exact);
  double apart = 0, size = 0;
  for (std::size_t n = 0; n < x.size(); ++n) {
    apart = std::max(apart, absolute_errors(x[n], exact[n])[3]);
    for (double lambda : exact[n].lambda) size = std::max(size, std::abs(lambda));
  }
  return {std::max(d.r, d.A), std::max(d.rd, d.w), std::max(d.rdd, d.wd), size > 0 ? apart / size : 0};
}

// Exact but for rounding, as positions are where drivers prescribe all of them: there is no order to see.
bool exact(const std::vector<double>& e) {
  return *std::max_element(e.begin(), e.end()) < 1e-10;
}

struct Convergence {
  std::vector<double> steps;
  std::array<std::vector<double>, 4> errors;
};

Convergence convergence(const Case& c, const Method& method, const std::string& formulation) {
  Convergence result;
  const double first = method.order < 2 ? c.step / 4 : c.step;  // the first order is met by smaller steps only
  const std::vector<Snapshot> exact = reference(c.scene, first, c.end, c.end / 4);
  for (const double divisor : {1.0, 1.5, 2.0, 3.0, 4.0}) {
    const double h = first / divisor;
    const Errors e = errors(motion(c.scene, settings_of(method.name, formulation, h, c.end, c.end / 4)), exact);
    result.steps.push_back(h);
    for (std::size_t k = 0; k < e.size(); ++k) result.errors[k].push_back(e[k]);
  }
  return result;
}

class Geometric : public ::testing::TestWithParam<std::string> {};  // by formulation

TEST_P(Geometric, OrderIsTheTheoreticalOneInEveryQuantity) {
  const std::vector<Method> methods = fixed_step_methods();
  std::map<std::string, std::array<int, kQuantities.size()>> seen;
  for (const Case& c : cases(GetParam())) {
    for (const Method& method : methods) {
      const Convergence found = convergence(c, method, GetParam());
      for (std::size_t k = 0; k < kQuantities.size(); ++k) {
        if (exact(found.errors[k])) continue;
        ++seen[method.name][k];
        EXPECT_TRUE(converges(found.steps, found.errors[k], method.order))
            << c.name << ", " << method.name << ", " << kQuantities[k];
      }
    }
  }
  for (const Method& method : methods) {
    for (std::size_t k = 0; k < kQuantities.size(); ++k) {
      EXPECT_GE(seen[method.name][k], 3) << method.name << ", " << kQuantities[k] << ": too few cases show an order";
    }
  }
}

// The first steps are as good as all others: errors there are at most a few times those of the second half, which are
// of order two, whatever the step. A start that loses an order stands out by 1/h, a hundredfold. (Half-implicit Euler
// has an error of order one in the first step, as its header says.)
TEST_P(Geometric, NoOrderReductionInTheFirstSteps) {
  for (const Case& c : cases(GetParam())) {
    for (const double h : {c.step / 2, c.step / 8}) {
      const std::vector<Snapshot> exact = reference(c.scene, c.step, c.end, h);
      for (const Method& method : kSecondOrder) {
        const std::vector<Snapshot> found = motion(c.scene, settings_of(method.name, GetParam(), h, c.end, 0));
        Errors early{}, later{};
        for (std::size_t n = 0; n < found.size(); ++n) {
          if (n > 10 && n < found.size() / 2) continue;  // where what the start left behind dies out
          const Errors e = absolute_errors(found[n], exact[n]);
          Errors& most = n <= 10 ? early : later;
          for (std::size_t k = 0; k < e.size(); ++k) most[k] = std::max(most[k], e[k]);
        }
        for (std::size_t k = 0; k < kQuantities.size(); ++k) {
          EXPECT_LE(early[k], 4 * later[k] + 1e-12)
              << c.name << ", " << method.name << ", " << kQuantities[k] << ", h " << h;
        }
      }
    }
  }
}

TEST_P(Geometric, ConstraintsAreKept) {
  for (const Case& c : cases(GetParam())) {
    for (const Method& method : kSecondOrder) {
      const Recorded r = run(c.scene, settings_of(method.name, GetParam(), c.step, c.end, 0));
      ASSERT_TRUE(r.outcome.status.ok()) << r.outcome.status.message;
      const auto& worst = r.outcome.statistics.violation;
      EXPECT_LT(worst.position, 1e-11) << c.name << ", " << method.name;
      if (method.name == "generalized_alpha") {
        EXPECT_GT(worst.velocity, 1e-9) << c.name << ": index 3 leaves the velocities to the order of the method";
      } else {
        EXPECT_LT(worst.velocity, 1e-10) << c.name << ", " << method.name;
      }
    }
  }
}

// There and back: the final state with its velocities turned round leads to the initial one.
double way_back(const Scene& scene, const std::string& integrator, const std::string& formulation, double step,
                double end) {
  const Settings settings = settings_of(integrator, formulation, step, end, end);
  const std::vector<Snapshot> forth = motion(scene, settings);
  Scene turned = scene;
  for (std::size_t b = 0; b < turned.bodies.size(); ++b) {
    const BodyState& state = forth.back().bodies[b];
    turned.bodies[b].position = state.r;
    turned.bodies[b].orientation = state.A;
    turned.bodies[b].velocity = -state.rd;
    turned.bodies[b].angular_velocity = -state.w;
  }
  std::vector<Snapshot> back = motion(turned, settings);
  for (BodyState& state : back.back().bodies) state.rd *= -1, state.w *= -1;
  const Distance d = distance({{0, back.back().bodies, {}}}, {{0, forth.front().bodies, {}}});
  return std::max({d.r, d.A, d.rd, d.w});
}

TEST_P(Geometric, RattleIsSymmetric) {
  const Scene pendulum = turning("double_pendulum", {0, 0, 1}), top = scene_of("heavy_top");
  EXPECT_LT(way_back(pendulum, "rattle", GetParam(), 0.01, 1), 1e-11);
  if (GetParam() != "reps") {  // the way back starts in another chart
    EXPECT_LT(way_back(top, "rattle", GetParam(), 2e-4, 0.05), 1e-11);
  }
  EXPECT_GT(way_back(pendulum, "generalized_alpha_i2", GetParam(), 0.01, 1), 1e-6);  // the measure sees what is not
}

TEST_P(Geometric, StepsCostOneFactorization) {
  const Scene scene = scene_of("double_pendulum");
  for (const auto& [integrator, more] : {std::pair{"rattle", 1}, std::pair{"half_implicit", 0}}) {
    const Recorded r = run(scene, settings_of(integrator, GetParam(), 0.01, 1, 1));
    EXPECT_EQ(r.outcome.statistics.steps, 100);
    EXPECT_EQ(r.outcome.statistics.factorizations, 100 + more) << integrator;
  }
}

TEST_P(Geometric, FailureNamesTimeAndPlaceAndKeepsWhatWasComputed) {
  Scene scene = scene_of("double_pendulum");
  for (const std::string integrator : {"generalized_alpha", "generalized_alpha_i2", "rattle", "half_implicit"}) {
    Settings settings = settings_of(integrator, GetParam(), 0.01, 1, 0);
    settings.max_iterations = 1;
    const Recorded r = run(scene, settings);
    EXPECT_EQ(r.outcome.status.failure, Failure::not_converged) << integrator;
    EXPECT_THAT(r.outcome.status.message, HasSubstr("at t = 0.01 s Newton's method did not converge"));
    EXPECT_THAT(r.outcome.status.message, HasSubstr("the largest correction is that of "));
    EXPECT_EQ(static_cast<std::int64_t>(r.samples.size()), r.outcome.statistics.steps + 1) << integrator;
  }
}

INSTANTIATE_TEST_SUITE_P(Formulations, Geometric, ::testing::ValuesIn(formulation_names()),
                         [](const auto& test) { return test.param; });

// A change of chart (reps) is a new start: no quantity loses its order over a run with one, at any step of it.
TEST(GeometricCharts, ChangeOfChartKeepsTheOrder) {
  const Case top{"heavy_top", scene_of("heavy_top"), 0.5, 5e-4};
  int charts = 0;
  double before = -1;
  Settings count = settings_of("rattle", "reps", top.step, top.end, 0);
  EXPECT_TRUE(simulate(top.scene, count, [&](const Sample& s) {
                charts += s.q[6] != before;  // φ, θ, ψ and the chart follow r
                before = s.q[6];
              }).status.ok());
  ASSERT_GE(charts, 2);
  std::vector<double> steps;
  std::array<std::array<std::vector<double>, 4>, 3> found;
  for (int level = 0; level < 5; ++level) {
    steps.push_back(top.step / (1 << level));
    const std::vector<Snapshot> exact = reference(top.scene, top.step, top.end, steps.back());
    for (std::size_t m = 0; m < kSecondOrder.size(); ++m) {
      const Errors e = errors(
          motion(top.scene, settings_of(kSecondOrder[m].name, "reps", steps.back(), top.end, steps.back())), exact);
      for (std::size_t k = 0; k < e.size(); ++k) found[m][k].push_back(e[k]);
    }
  }
  for (std::size_t m = 0; m < kSecondOrder.size(); ++m) {
    for (std::size_t k = 0; k < kQuantities.size(); ++k) {
      EXPECT_TRUE(converges(steps, found[m][k], 2)) << kSecondOrder[m].name << ", " << kQuantities[k];
    }
  }
}

// Velocity rows: the knife edge has its motion in closed form, x = c sin²(wt)/(2w²).
TEST(GeometricRows, VelocityRowsAreSecondOrder) {
  const double c = 9.81 * std::sin(std::acos(-1) / 6), w = 2, t = 0.8;
  const double x = c * std::pow(std::sin(w * t), 2) / (2 * w * w);
  for (const Method& method : kSecondOrder) {
    for (const std::string& formulation : formulation_names()) {
      std::vector<double> steps, found;
      for (int level = 0; level < 5; ++level) {
        steps.push_back(0.02 / (1 << level));
        found.push_back(
            std::abs(motion(scene_of("knife_edge"), settings_of(method.name, formulation, steps.back(), t, t))
                         .back()
                         .bodies[0]
                         .r.x() -
                     x));
      }
      EXPECT_TRUE(converges(steps, found, 2)) << method.name << ' ' << formulation;
    }
  }
}

// Energy over a run, E(t) − E(0) at even times.
std::vector<double> energies(const Scene& scene, const Settings& settings) {
  std::vector<double> e;
  EXPECT_TRUE(simulate(scene, settings, [&](const Sample& s) { e.push_back(s.problem.energy()); }).status.ok());
  for (std::size_t k = e.size(); k-- > 0;) e[k] -= e[0];
  return e;
}
double largest(const std::vector<double>& e) {
  return std::abs(*std::max_element(e.begin(), e.end(), [](double a, double b) { return std::abs(a) < std::abs(b); }));
}
// Change over the whole run of the straight line fitted to it.
double trend(const std::vector<double>& e) {
  const auto n = static_cast<double>(e.size());
  const double middle = (n - 1) / 2, mean = std::accumulate(e.begin(), e.end(), 0.0) / n;
  double sxy = 0, sxx = 0;
  for (std::size_t k = 0; k < e.size(); ++k) {
    const double x = static_cast<double>(k) - middle;
    sxy += x * (e[k] - mean);
    sxx += x * x;
  }
  return sxy / sxx * (n - 1);
}

TEST(GeometricEnergy, RattleIsBoundedWithoutTrend) {
  const Scene scene = scene_of("double_pendulum");
  for (const char* formulation : {"rA", "rp"}) {
    const std::vector<double> coarse = energies(scene, settings_of("rattle", formulation, 0.01, 1000, 0.05));
    const std::vector<double> fine = energies(scene, settings_of("rattle", formulation, 0.005, 200, 0.05));
    const double amplitude = largest(coarse);
    EXPECT_LT(amplitude, 0.03 * 382.6) << formulation;  // of the energy, −382.6 J; kinetic energy comes up to 1200 J
    EXPECT_LT(std::abs(trend(coarse)), 0.1 * amplitude) << formulation;
    EXPECT_LT(largest(fine), 0.35 * amplitude) << formulation;  // order two
    const std::vector<double> euler = energies(scene, settings_of("implicit_euler", formulation, 0.01, 20, 0.05));
    EXPECT_LT(euler.back(), -30 * amplitude) << formulation;  // in a fiftieth of the time
    EXPECT_LT(trend(euler), -0.5 * largest(euler)) << formulation;
  }
}

// A body without forces: the angular momentum in space and, with the error of the method, the energy.
TEST(GeometricEnergy, RattleKeepsAngularMomentum) {
  const Scene scene = scene_of("free_body");
  const auto drift = [&](const std::string& integrator, const std::string& formulation) {
    std::vector<Vector3> momentum;
    Settings settings = settings_of(integrator, formulation, 0.1, 200, 0);
    settings.tolerance = 1e-14;
    for (const Snapshot& s : motion(scene, settings)) {
      momentum.push_back(s.bodies[0].A * (scene.bodies[0].inertia * s.bodies[0].w));
    }
    double worst = 0;
    for (const Vector3& m : momentum) worst = std::max(worst, (m - momentum[0]).norm() / momentum[0].norm());
    return worst;
  };
  EXPECT_LT(drift("rattle", "rA"), 1e-11);
  EXPECT_LT(drift("rattle", "rp"), 1e-11);
  EXPECT_GT(drift("generalized_alpha", "rA"), 1e-6);  // the measure sees what is not kept
  const std::vector<double> energy = energies(scene, settings_of("rattle", "rA", 0.1, 1000, 0));
  EXPECT_LT(largest(energy), 3e-4);  // 1 J
  EXPECT_LT(std::abs(trend(energy)), 0.05 * largest(energy));
}

TEST(GeometricSettings, SpectralRadiusDamps) {
  const Scene scene = scene_of("double_pendulum");
  const auto lost = [&](double radius) {
    Settings s = settings_of("generalized_alpha_i2", "rA", 0.01, 20, 0.05);
    s.spectral_radius = radius;
    return -trend(energies(scene, s));
  };
  EXPECT_GT(lost(0), 5 * lost(0.8));
  for (double radius : {-0.1, 1.1, std::nan("")}) {
    Settings s;
    s.spectral_radius = radius;
    EXPECT_THROW((void)simulate(scene, s, {}), InputError) << radius;
  }
}

// A spring far too stiff for the step, out of rest: the start must not take its v̈ for the motion's.
TEST(GeometricStart, UnresolvedSpringStaysBounded) {
  Scene scene = parse_scene(R"json({"scene": 1, "name": "stiff",
    "bodies": [{"name": "ball", "mass": 1, "inertia": [1, 1, 1], "position": ["1 + 1e-7", 0, 0]}],
    "forces": [{"type": "spring", "bodies": ["ground", "ball"], "s_i": [0, 0, 0], "s_j": [0, 0, 0], "stiffness": 1e10, "damping": 1, "length": 1}]})json",
                            "stiff");
  for (const std::string integrator : {"generalized_alpha", "generalized_alpha_i2"}) {
    Settings settings = settings_of(integrator, "rA", 0.01, 1, 0);  // h ω = 1000
    settings.tolerance = 1e-6;                                      // accelerations are of order 1e3
    const std::vector<Snapshot> found = motion(scene, settings);
    for (const Snapshot& s : found) ASSERT_LT(std::abs(s.bodies[0].r.x() - 1), 2e-7) << integrator << ' ' << s.t;
    EXPECT_LT(std::abs(found.back().bodies[0].r.x() - 1), 1e-9) << integrator;
  }
}

// Every refusal of every integrator, made to say why.
TEST(IntegratorRegistry, RefusalsAreInputErrors) {
  const Scene scene = scene_of("double_pendulum");
  for (const IntegratorEntry& entry : integrators()) {
    for (const Refusal& refusal : entry.refuses) {
      ASSERT_NE(find_formulation(refusal.formulation), nullptr) << entry.name;
      Settings s;
      s.integrator = entry.name;
      s.formulation = refusal.formulation;
      try {
        (void)simulate(scene, s, {});
        ADD_FAILURE() << entry.name << " takes " << refusal.formulation;
      } catch (const InputError& error) {
        EXPECT_THAT(error.what(), HasSubstr(std::string(refusal.why)));
      }
    }
  }
}

}  // namespace
}  // namespace poinsot::test
