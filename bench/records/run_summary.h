// The summary that a run prints: where the bodies are at its end, what it cost, who solved it.
#pragma once

#include <string>
#include <vector>

#include "core/body_state.h"
#include "core/scene.h"
#include "integrators/simulate.h"

namespace poinsot::records {

// The motion at the last output time, of the first bodies.
struct LastState {
  double t = 0;
  std::vector<BodyState> bodies;

  void keep(const Sample& sample);
};

// Lines.
std::string run_summary(const Scene& scene, const Settings& settings, const Outcome& outcome, const LastState& last);

}  // namespace poinsot::records
