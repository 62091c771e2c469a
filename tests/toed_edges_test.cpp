// Bodies on knife edges and dampers, which act on velocities: these are those of rigid bodies in every formulation, and
// what stabilized index 2 moves a mechanism by, normal to the constraints, is not carried from step to step in
// directions that were normal once.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "core/scene_reader.h"
#include "tests/support/simulation.h"

namespace poinsot::test {
namespace {

// A plate in its plane on two knife edges, at (0, −1/2) and (0, 1/2) of it, whose directions are `toe` rad apart. At
// the second one both allow it to turn, at 1 rad/s.
Scene toed(double toe) {
  return parse_scene(fmt::format(R"j({{"scene": 1, "gravity": [0, 0, 0], "bodies": [
      {{"name": "plate", "mass": 2, "inertia": [0.4, 0.4, 0.4], "position": [0, 0, 0], "velocity": [0.5, 0, 0],
        "angular_velocity": [0, 0, 1]}}],
      "constraints": [
      {{"type": "CD", "bodies": ["ground", "plate"], "c": [0, 0, 1], "s_i": [0, 0, 0], "s_j": [0, 0, 0]}},
      {{"type": "DP1", "bodies": ["ground", "plate"], "a_i": [0, 0, 1], "a_j": [1, 0, 0]}},
      {{"type": "DP1", "bodies": ["ground", "plate"], "a_i": [0, 0, 1], "a_j": [0, 1, 0]}},
      {{"type": "pfaffian", "bodies": ["ground", "plate"], "a_j": [0, 1, 0], "s_i": [0, 0, 0], "s_j": [0, -0.5, 0]}},
      {{"type": "pfaffian", "bodies": ["ground", "plate"], "a_j": [{0:.17g}, {1:.17g}, 0], "s_i": [0, 0, 0],
        "s_j": [0, 0.5, 0]}}]}})j",
                                 -std::sin(toe), std::cos(toe)),
                     "toed");
}

TEST(ToedEdges, TurnAboutOneOfThem) {
  for (const double toe : {1.0, 0.1, 0.03})
    for (const FormulationEntry& formulation : formulations()) {
      Settings settings;
      settings.integrator = "generalized_alpha_i2", settings.formulation = formulation.name;
      settings.step = 5e-3, settings.end = 6;
      for (const Snapshot& at : motion(toed(toe), settings)) {
        const Vector3 right(0.5 * std::sin(at.t), 0.5 - 0.5 * std::cos(at.t), 0);
        ASSERT_LT((at.bodies[0].r - right).norm(), 1e-5) << toe << ' ' << formulation.name << " t = " << at.t;
      }
    }
}

// In rp p·ṗ is not 0 within a step of either Euler method, and what would stretch bodies so is all that edges nearly
// parallel have to go by, if rows see it: 1.4 rad/s too little at 3e-5 rad.
TEST(ToedEdges, AreOfRigidBodiesInEveryFormulation) {
  for (const double toe : {0.1, 3e-3, 3e-5})
    for (const IntegratorEntry& method : integrators()) {
      if (method.analysis != Analysis::dynamics || method.controls_error) continue;
      for (const FormulationEntry& formulation : formulations()) {
        Settings settings;
        settings.integrator = method.name, settings.formulation = formulation.name;
        settings.step = 1e-3, settings.end = 1;
        const Snapshot at = motion(toed(toe), settings).back();
        const Vector3 right(0.5 * std::sin(at.t), 0.5 - 0.5 * std::cos(at.t), 0);
        EXPECT_LT((at.bodies[0].r - right).norm(), 3e-4) << toe << ' ' << formulation.name << ' ' << method.name;
      }
    }
}

// Nor do stretches act on a damper (rp drove these two apart by 0.06 to 0.1 rad/s, whatever the damping).
TEST(Dampers, LeaveBodiesAloneThatTurnTogether) {
  const Scene scene = parse_scene(R"j({"scene": 1, "gravity": [0, 0, 0], "bodies": [
      {"name": "a", "mass": 2, "inertia": [0.4, 0.4, 0.4], "position": [0, 0, 0], "angular_velocity": [0, 0, 10]},
      {"name": "b", "mass": 2, "inertia": [0.4, 0.4, 0.4], "position": [0, 0, 0], "angular_velocity": [0, 0, 10]}],
      "joints": [{"type": "revolute", "bodies": ["ground", "a"], "point": [0, 0, 0], "axis": [0, 0, 1]},
                 {"type": "revolute", "bodies": ["ground", "b"], "point": [0, 0, 0], "axis": [0, 0, 1]}],
      "forces": [{"type": "spring", "bodies": ["a", "b"], "s_i": [0.5, 0, 0], "s_j": [1.0, 0.2, 0], "stiffness": 0,
                  "damping": 1e4, "length": 0}]})j",
                                  "together");
  for (const IntegratorEntry& method : integrators()) {
    if (method.analysis != Analysis::dynamics || method.controls_error) continue;
    for (const FormulationEntry& formulation : formulations()) {
      Settings settings;
      settings.integrator = method.name, settings.formulation = formulation.name;
      settings.step = 1e-3, settings.end = 1;
      const Snapshot at = motion(scene, settings).back();
      EXPECT_LT((at.bodies[0].A - at.bodies[1].A).norm(), 1e-5) << formulation.name << ' ' << method.name;
    }
  }
}

// m/s, by which positions go otherwise than velocities say: by differences of fourth order over steps.
double positions_from_velocities(const std::vector<Snapshot>& at) {
  double most = 0;
  for (std::size_t k = 2; k + 2 < at.size(); ++k)
    for (std::size_t b = 0; b < at[k].bodies.size(); ++b) {
      const auto r = [&](std::size_t n) { return at[n].bodies[b].r; };
      const Vector3 rate = (r(k - 2) - 8 * r(k - 1) + 8 * r(k + 1) - r(k + 2)) / (12 * (at[k + 1].t - at[k].t));
      most = std::max(most, (rate - at[k].bodies[b].rd).norm());
    }
  return most;
}

TEST(StabilizedIndex2, PositionsGoWithVelocities) {
  const std::pair<const char*, double> cases[] = {{"heavy_top", 2e-3}, {"gyroscope", 3e-5}};
  for (const auto& [name, allowed] : cases) {
    Settings settings;
    settings.integrator = "generalized_alpha_i2", settings.formulation = "rA", settings.step = 1e-3, settings.end = 1;
    EXPECT_LT(positions_from_velocities(motion(scene_of(name), settings)), allowed) << name;
  }
}

}  // namespace
}  // namespace poinsot::test
