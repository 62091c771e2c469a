// Builds a double pendulum without a file, lets it swing for two seconds, and prints how it moves and what its hinges
// carry.
#include <poinsot/core/input_error.h>
#include <poinsot/integrators/simulate.h>
#include <poinsot/integrators/start/reactions.h>

#include <cstdio>
#include <optional>
#include <vector>

namespace {

// Two rods of 1 m and 1 kg along y, hinged about x: to the ground at the origin, and one to the other.
poinsot::Scene double_pendulum() {
  poinsot::Scene scene;
  scene.name = "double pendulum";
  scene.gravity = {0, 0, -9.81};
  for (const double start : {0.0, 1.0}) {
    poinsot::Body rod;
    rod.name = start == 0 ? "upper" : "lower";
    rod.mass = 1;
    rod.inertia = poinsot::Vector3(1.0 / 12, 1e-3, 1.0 / 12).asDiagonal();
    rod.position = {0, start + 0.5, 0};
    scene.bodies.push_back(rod);
    poinsot::Joint hinge;
    hinge.type = poinsot::JointType::revolute;
    hinge.i = start == 0 ? poinsot::kGround : 0;
    hinge.j = start == 0 ? 0 : 1;
    hinge.point = {0, start, 0};
    hinge.axis = {1, 0, 0};
    scene.joints.push_back(hinge);
  }
  return scene;
}

}  // namespace

int main() {
  const poinsot::Scene scene = double_pendulum();
  poinsot::Settings settings;
  settings.integrator = "dopri5";
  settings.rtol = 1e-10;
  settings.end = 2;
  settings.every = 0.5;

  std::vector<poinsot::BodyState> bodies(scene.bodies.size());
  std::optional<poinsot::Reactions> reactions;
  const auto observe = [&](const poinsot::Sample& sample) {
    sample.problem.to_bodies(sample.a, bodies);
    if (!reactions) reactions.emplace(sample.problem);
    reactions->update(sample);
    poinsot::Vector3 force, moment;  // on the upper rod, at the hinge to the ground
    reactions->of_group(0, force, moment);
    std::printf("t %.1f lower %.6f %.6f hinge %.6f %.6f\n", sample.t, bodies[1].r.y(), bodies[1].r.z(), force.y(),
                force.z());
  };
  try {
    const poinsot::Outcome outcome = poinsot::simulate(scene, settings, observe);
    if (!outcome.status.ok()) {
      std::fprintf(stderr, "%s\n", outcome.status.message.c_str());
      return 3;
    }
  } catch (const poinsot::InputError& error) {
    std::fprintf(stderr, "%s\n", error.what());
    return 2;
  }
  return 0;
}
