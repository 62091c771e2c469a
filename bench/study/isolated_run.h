// A run in a process of its own, so that the memory it needs can be told from everything before it.
//
// The first steps are not like the others: in the first one the linear solver chooses its pivots and examines what it
// may rely on, and it looks at each of the first eight solutions. In a large scene, of which only a few steps are
// timed, that would weigh as much as the steps. So the first ten are run alone, too; costs per iteration are those of
// the steps after them, and start-up is what the run takes beyond its iterations at that cost.
#pragma once

#include <string>

#include "core/scene_generator.h"
#include "integrators/settings.h"

namespace poinsot::study {

// Plain numbers: they come out of the process through a pipe.
struct RunFigures {
  double us_per_body = 0;                                // and Newton iteration, after the first steps
  double assembly = 0, factor = 0, solve = 0, rest = 0;  // the same by phase
  double start = 0;                                      // s that the run takes beyond its iterations
  double kilobytes_per_body = 0;                         // resident, beyond an idle process
  double seconds = 0;                                    // of the whole run
  int bodies = 0;
};

// Steps at the beginning whose iterations are not timed.
inline constexpr int kUntimedSteps = 10;

struct IsolatedRun : RunFigures {
  std::string failure;  // why there are no figures
};

// Ends at once where an end is asked for (core/interruption.h), with a failure that says nothing.
IsolatedRun run_isolated(const SceneGenerator& generator, int bodies, const Settings& settings);

}  // namespace poinsot::study
