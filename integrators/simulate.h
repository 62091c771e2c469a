// From a scene and a configuration to a motion: the one way in for the command line, the benchmarks and other programs.
//
// Checks the settings against the registries, compiles the model, sets dependent rows aside, projects the initial state
// where it has to, finds the initial accelerations and multipliers, and runs the integrator.
//
// A program steps by observing: `observe` is called with a Sample at t = 0, at every output time (`every`, or each
// step) and at the end, from within the run. It asks sample.problem, which stands there:
//
//   std::vector<BodyState> bodies(scene.bodies.size());
//   const Outcome outcome = simulate(scene, settings, [&](const Sample& sample) {
//     sample.problem.to_bodies(sample.a, bodies);  // positions, velocities, accelerations by body
//     std::printf("%g %g\n", sample.t, bodies[0].r.z());
//   });
//   if (!outcome.status.ok()) std::puts(outcome.status.message.c_str());
//
// Numbers below 2.2e-308 are zero to whatever is called from within the run (core/flush_subnormals.h).
//
// Reactions are in integrators/start/reactions.h; kinematics finds them where Settings::reactions asks. Energies, joint
// coordinates, efforts of drivers and forces of springs are in integrators/signals.h, where Settings::signals asks.
#pragma once

#include <string>
#include <vector>

#include "core/scene.h"
#include "integrators/integrator.h"

namespace poinsot {

struct Outcome {
  Status status;
  Statistics statistics;
  std::vector<std::string> notices;  // what the user should know of: projections, dependent rows, singular starts
  // Constraints, joints and drivers whose reactions redundant rows leave undetermined at the start or at the end: those
  // given are the least.
  std::vector<std::string> undetermined_reactions;
  // Of each of these its components that are, there ("fz", "nx"); the others are unique. None of constraints.
  std::vector<std::vector<std::string>> undetermined_components;
};

// Throws InputError where settings or scene break a rule, or do not fit together (unknown name, kinematics with free
// motion, ...), before anything is observed. Numerical failure is in the outcome's status.
// `tell` is told every notice at once, also those that come up while the run is under way; they are in the outcome as
// well.
Outcome simulate(const Scene& scene, const Settings& settings, const Observer& observe, const Tell& tell = {});

}  // namespace poinsot
