// Scenes saved on the way: running on from them continues the motion.
#include "core/saved_scene.h"

#include <gtest/gtest.h>

#include <cstdlib>
#include <filesystem>

#include "tests/support/simulation.h"

namespace poinsot::test {
namespace {

TEST(SavedScene, ShiftsFunctionsOfTime) {
  EXPECT_EQ(later("cos(pi*t + tan(2))", 0.5), "cos(pi*(t + 0.5) + tan(2))");
  EXPECT_EQ(later("t^2 + 1.5e-3*table(t)", 2), "(t + 2)^2 + 1.5e-3*table((t + 2))");
  EXPECT_EQ(later("sin((t + 0.5))", 0.25), "sin((t + 0.75))");
  EXPECT_EQ(later("(t + 0.5*t)", 1), "((t + 1) + 0.5*(t + 1))");
  EXPECT_EQ(later("2*pi", 3), "2*pi");
  for (const char* text : {"sin(pi*t)/(1 + t)", "exp(-t)*t^2", "max(t, 0.3)"}) {
    const Expression f = Expression::parse(text), g = Expression::parse(later(later(text, 0.25), 0.5));
    EXPECT_EQ(g.at(0.125).f, f.at(0.875).f) << text;
    EXPECT_EQ(g.at(0.125).fdd, f.at(0.875).fdd) << text;
  }
}

struct Half {
  std::string text;  // the scene at the end
  std::vector<Snapshot> samples;
};
Half run_and_save(const Scene& scene, const Settings& settings) {
  Half half;
  std::vector<double> twists;
  const Outcome outcome = simulate(scene, settings, [&](const Sample& sample) {
    half.samples.push_back(snapshot(sample));
    twists.clear();
    for (std::size_t k = 0; k < sample.problem.model().torsions.size(); ++k)
      twists.push_back(sample.problem.twist(static_cast<int>(k)));
  });
  EXPECT_TRUE(outcome.status.ok()) << scene.name << ": " << outcome.status.message;
  half.text = saved_scene(scene, half.samples.back().t, half.samples.back().bodies, twists);
  return half;
}

// Positions and velocities at the end of both halves and of the whole.
Distance apart(const Scene& scene, Settings settings) {
  const Snapshot through = motion(scene, settings).back();
  settings.end /= 2;
  const Half first = run_and_save(scene, settings);
  Snapshot second = motion(parse_scene(first.text, "saved"), settings).back();
  second.t = through.t;
  return distance({second}, {through});
}

TEST(SavedScene, RunningOnIsRunningThroughForEveryModel) {
  int models = 0;
  for (const std::string& name : model_names()) {
    const Scene scene = scene_of(name);
    Settings settings = dynamics("rA", 1e-3, 0.04, 0.02);
    settings.integrator = "rattle";  // its state is q and v alone, and lies on the constraints
    settings.tolerance = 1e-9;
    if (name == "andrews" || name == "steel_pendulum")  // quick, and stiff
      settings.step = 1e-5, settings.end = 4e-4, settings.every = 2e-4;
    const Distance d = apart(scene, settings);
    const double frequency = name == "steel_pendulum" ? 1e4 : 1;  // 1/s, of the rope: positions are velocities times it
    EXPECT_LT(std::max({d.r, d.A, d.rd / frequency, d.w}), 1e-12) << name << ": " << d;
    ++models;
  }
  EXPECT_GT(models, 15);
}

TEST(SavedScene, RunningOnWithErrorControlIsRunningThroughToItsTolerance) {
  for (const char* name : {"four_link_joints", "double_pendulum_joints", "heavy_top"}) {
    const Distance d = apart(scene_of(name), controlled("dop853", "rA", 1e-12, 1, 0.5));
    EXPECT_LT(std::max({d.r, d.A, d.rd, d.w}), 1e-9) << name << ": " << d;
  }
}

// Angles with their turns, reference directions that are not about a hinge, parameters of time in forces.
TEST(SavedScene, KeepsZerosAndTurns) {
  const Scene scene = parse_scene(R"json({
    "scene": 1, "name": "turns", "gravity": [0, 0, -9.81],
    "bodies": [{"name": "wheel", "mass": 1, "inertia": [1, 1, 2], "position": [0, 0, 0], "angular_velocity": [0, 0, 30]},
               {"name": "free", "mass": 1, "inertia": [1, 2, 3], "position": [1, 0, 0], "angular_velocity": [1, 2, 3]}],
    "joints": [{"type": "revolute", "bodies": ["ground", "wheel"], "point": [0, 0, 0], "axis": [0, 0, 1]},
               {"type": "spherical", "bodies": ["wheel", "free"], "point": [1, 0, 0.2]}],
    "forces": [{"type": "torsion_spring", "bodies": ["ground", "wheel"], "axis": [0, 0, 1], "stiffness": 2, "damping": 0.1},
               {"type": "torsion_spring", "bodies": ["wheel", "free"], "axis": [0, 1, 0.3], "stiffness": 3, "angle": "pi/7"},
               {"type": "force", "body": "free", "point": [0, 0.1, 0], "force": ["sin(5*t)", 0, "t"]}]
})json",
                                  "turns");
  Settings settings = dynamics("rA", 1e-3, 1, 0.5);
  settings.integrator = "rattle";
  settings.tolerance = 1e-9;
  const Distance d = apart(scene, settings);
  EXPECT_LT(std::max({d.r, d.A, d.rd, d.w}), 1e-11) << d;
}

}  // namespace
}  // namespace poinsot::test
