// The summary that a run prints: where the bodies are at its end, what it cost, who solved it.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "core/body_state.h"
#include "core/scene.h"
#include "integrators/simulate.h"

namespace poinsot::records {

// The motion at the last output time, of the first bodies.
struct LastState {
  std::optional<double> t;  // nothing: the run did not come to its first
  std::vector<BodyState> bodies;

  void keep(const Sample& sample);
};

// Lines: of a run that did not come to a state, or to the end of a step, those that are known all the same.
std::string run_summary(const Scene& scene, const Settings& settings, const Outcome& outcome, const LastState& last);

}  // namespace poinsot::records
