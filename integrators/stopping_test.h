// When Newton's method for the unknowns (a, λ) of a step is done: the configuration's key "stopping".
#pragma once

#include <string_view>

#include "core/registry.h"

namespace poinsot {

enum class Stopping {
  relative,    // the largest correction of a body's acceleration beside accelerations (stepping/newton_loop.h)
  correction,  // the 2-norm of the correction of all unknowns
};

struct StoppingEntry {
  std::string_view name;
  std::string_view about;
  Stopping test;
};

Registry<StoppingEntry>& stopping_tests();

}  // namespace poinsot
