// Radau IIA: orders of every quantity, stiff scenes.
#include <gmock/gmock.h>

#include "integrators/methods/dop853.h"
#include "tests/support/equal_steps.h"
#include "tests/support/forced_scene.h"
#include "tests/support/rows_scene.h"

namespace poinsot::test {
namespace {

class Radau : public ::testing::TestWithParam<std::string> {};  // by formulation

INSTANTIATE_TEST_SUITE_P(Formulations, Radau, ::testing::ValuesIn(formulation_names()),
                         [](const auto& test) { return test.param; });

EqualSteps<RadauStepper> bench(const Scene& scene, Settings settings) {
  settings.linear_solver = "dense";  // fresh pivots: orders are measured down to 1e-13
  return {scene, settings, [&](Problem& problem, LinearSystems& systems, Statistics& statistics, PhaseClock& clock) {
            return std::make_unique<RadauStepper>(problem, systems, settings.rtol, settings.absolute_tolerance(),
                                                  statistics, clock);
          }};
}

struct RadauOrder {
  std::string model;
  double end;
  std::vector<int> counts;  // of steps
};

TEST_P(Radau, OrderIsTheTheoreticalOneInEveryQuantity) {
  for (const RadauOrder& c :
       {RadauOrder{"forced", 1, {76, 88, 108, 128, 156}}, RadauOrder{"rows", 0.4, {36, 40, 44, 52, 60}},
        RadauOrder{"heavy_top", 1, {76, 92, 112, 132, 160}}}) {
    Scene scene = c.model == "forced" ? forced() : c.model == "rows" ? rows_of_every_kind() : scene_of(c.model);
    if (c.model == "heavy_top") scene.bodies[0].angular_velocity = {2.6, -4.2, 1.4};  // slow
    const Settings exactly = controlled("dop853", GetParam(), 1e-14, c.end, c.end / 4);
    std::vector<Snapshot> exact = motion(scene, exactly);
    exact.erase(exact.begin());
    const Settings s = controlled("radau5", GetParam(), 1e-14, c.end);
    std::vector<double> steps;
    std::array<std::vector<double>, 4> found;
    for (const int count : c.counts) {
      steps.push_back(c.end / count);
      const auto e = mean_errors(quarters(bench(scene, s), c.end, count), exact);
      for (std::size_t k = 0; k < e.size(); ++k) found[k].push_back(e[k]);
    }
    for (std::size_t k = 0; k < found.size(); ++k) {
      EXPECT_TRUE(converges(steps, found[k], 5)) << c.model << ", " << kQuantities[k];
    }
  }
}

// A pendulum that swings slowly and drags another by a stiff and strongly damped spring, whose turning is damped, too:
// time constants from 1e-5 s to 1 s.
Scene stiff() {
  return parse_scene(R"json({
    "scene": 1, "name": "stiff", "gravity": [0, 0, -9.81],
    "bodies": [
      {"name": "rod", "mass": 1, "inertia": [0.1, 0.01, 0.1], "position": [0, 0.5, 0]},
      {"name": "tip", "mass": 0.5, "inertia": [0.01, 0.01, 0.01], "position": [0, 1.5, 0]}],
    "joints": [{"type": "revolute", "bodies": ["ground", "rod"], "point": [0, 0, 0], "axis": [1, 0, 0]}],
    "forces": [
      {"type": "spring", "bodies": ["rod", "tip"], "s_i": [0, 0.5, 0], "s_j": [0, 0, 0], "stiffness": 1e5, "damping": 1e4, "length": 0.5},
      {"type": "torsion_spring", "bodies": ["ground", "rod"], "axis": [1, 0, 0], "stiffness": 1, "damping": 0.2, "angle": 0},
      {"type": "linear_drag", "body": "tip", "translational": 0.1, "rotational": 1e3}]})json",
                     "stiff");
}

TEST_P(Radau, TakesStiffScenesWithLongSteps) {
  const Scene scene = stiff();
  const double end = 1;
  const Recorded radau = run(scene, controlled("radau5", GetParam(), 1e-6, end, 0.25));
  ASSERT_TRUE(radau.outcome.status.ok()) << radau.outcome.status.message;
  const std::vector<Snapshot> exact = motion(scene, controlled("radau5", "rA", 1e-11, end, 0.25));
  const Distance apart = distance(radau.samples, exact);
  EXPECT_LT(std::max({apart.r, apart.A, apart.rd, apart.w}), 1e-4);
  EXPECT_LT(radau.outcome.statistics.steps, 100);

  const double short_end = 0.01;  // the explicit pair is bounded by its stability
  const Recorded dopri = run(scene, controlled("dopri5", GetParam(), 1e-6, short_end, short_end));
  ASSERT_TRUE(dopri.outcome.status.ok()) << dopri.outcome.status.message;
  EXPECT_GT(static_cast<double>(dopri.outcome.statistics.steps) / short_end,
            50 * static_cast<double>(radau.outcome.statistics.steps) / end);
}

// Within steps that are long beside a stiff spring Newton's method may not take a shorter one; then a sample is of the
// polynomial of the step.
TEST_P(Radau, SamplesOfLongStepsAreThere) {
  const Scene scene = scene_of("stiff_pendulum");
  const double end = 1.2, every = 0.002;
  const auto exact = motion(scene, controlled("radau5", "rA", 1e-9, end, every));
  for (const double rtol : {0.1, 3e-2}) {
    const Distance d = distance(motion(scene, controlled("radau5", GetParam(), rtol, end, every)), exact);
    EXPECT_LT(std::max(d.r, d.A), 5 * rtol) << d;
  }
}

// The stiff reference itself, against a method that knows nothing of stiffness.
TEST(RadauStiff, AgreesWithAnExplicitMethod) {
  const double end = 0.02;
  const auto radau = motion(stiff(), controlled("radau5", "rA", 1e-11, end, end));
  const auto explicitly = motion(stiff(), controlled("dop853", "rA", 1e-11, end, end));
  const Distance apart = distance(radau, explicitly);
  EXPECT_LT(std::max({apart.r, apart.A, apart.rd, apart.w}), 1e-8);
}

}  // namespace
}  // namespace poinsot::test
