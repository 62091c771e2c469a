// Integrators of fixed step: orders of every quantity, in every step and over changes of chart.
#include <map>

#include "tests/support/fixed_step_cases.h"

namespace poinsot::test {
namespace {

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

class FixedStep : public ::testing::TestWithParam<std::string> {};  // by formulation

INSTANTIATE_TEST_SUITE_P(Formulations, FixedStep, ::testing::ValuesIn(formulation_names()),
                         [](const auto& test) { return test.param; });

TEST_P(FixedStep, OrderIsTheTheoreticalOneInEveryQuantity) {
  const std::vector<Method> methods = fixed_step_methods();
  std::map<std::string, std::array<int, kQuantities.size()>> seen;
  for (const Case& c : cases(GetParam())) {
    for (const Method& method : methods) {
      const Convergence found = convergence(c, method, GetParam());
      for (std::size_t k = 0; k < kQuantities.size(); ++k) {
        if (exact(found.errors[k])) continue;
        ++seen[method.name][k];
        // Accelerations given out at index 1 converge faster at first: generalized-alpha's by up to h^2.28.
        EXPECT_TRUE(converges(found.steps, found.errors[k], method.order, k == 2 ? 0.3 : 0.1))
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
TEST_P(FixedStep, NoOrderReductionInTheFirstSteps) {
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

// Of reps, that a motion of one body passes through.
int charts(const Case& c) {
  int count = 0;
  double before = -1;
  const Settings settings = settings_of("rattle", "reps", c.step, c.end, 0);
  EXPECT_TRUE(simulate(c.scene, settings, [&](const Sample& s) {
                count += s.q[6] != before;  // φ, θ, ψ and the chart follow r
                before = s.q[6];
              }).status.ok());
  return count;
}

// A change of chart (reps) is a new start: no quantity loses its order over a run with one, at any step of it.
TEST(FixedStepCharts, ChangeOfChartKeepsTheOrder) {
  const Case top{"heavy_top", scene_of("heavy_top"), 0.5, 5e-4};
  ASSERT_GE(charts(top), 2);
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

// Nor does one of the first order.
TEST(FixedStepCharts, ChangeOfChartKeepsTheFirstOrder) {
  const Case top{"heavy_top", scene_of("heavy_top"), 0.4, 2e-4};
  ASSERT_GE(charts(top), 2);
  for (const Method& method : fixed_step_methods()) {
    if (method.order > 1) continue;
    const Convergence found = convergence(top, method, "reps");
    for (std::size_t k = 0; k < kQuantities.size(); ++k) {
      EXPECT_TRUE(converges(found.steps, found.errors[k], 1)) << method.name << ", " << kQuantities[k];
    }
  }
}

// Velocity rows: the knife edge has its motion in closed form, x = c sin²(wt)/(2w²).
TEST(FixedStepRows, VelocityRowsAreSecondOrder) {
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

// Not even in the step that begins in the new chart, or the first of all, whose velocity is none of the scheme's where
// that makes velocities of differences of positions. A pendulum that is under way, with its hinge and its frame askew.
TEST(FixedStepCharts, NoStepLosesTheFirstOrder) {
  const Case pendulum{"pendulum",
                      parse_scene(R"j({"scene": 1, "gravity": [0, 0, -9.81], "bodies": [{"name": "rod",
      "mass": 1, "inertia": [0.1, 0.1, 0.1], "position": [-0.2876553231625218, 0.5265495371342236, 0],
      "orientation": {"euler_parameters": [0.9686629266365361, -0.07965179448796547, -0.13436388130975224,
        0.1931167356656754]}, "velocity": [0, 0, 2.4],
      "angular_velocity": [3.8802703861173287, 0.5121483053732561, -0.8253519515480532]}],
    "joints": [{"type": "revolute", "bodies": ["ground", "rod"], "point": [0, 0, 0],
      "axis": [0.8775825618903728, 0.479425538604203, 0]}]})j",
                                  "pendulum"),
                      1.2, 4e-3};
  ASSERT_GE(charts(pendulum), 2);
  for (const Method& method : fixed_step_methods()) {
    if (method.order > 1) continue;
    std::array<Errors, 2> found;
    for (const int level : {0, 1}) {
      const double h = pendulum.step / (level == 0 ? 1 : 4);
      found[index(level)] = errors(motion(pendulum.scene, settings_of(method.name, "reps", h, pendulum.end, h)),
                                   reference(pendulum.scene, h, pendulum.end, h));
    }
    for (std::size_t k = 0; k < kQuantities.size(); ++k)
      EXPECT_LT(found[1][k], found[0][k] / 2.5) << method.name << ", " << kQuantities[k];
  }
}

}  // namespace
}  // namespace poinsot::test
