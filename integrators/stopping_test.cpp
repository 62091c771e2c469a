#include "integrators/stopping_test.h"

namespace poinsot {
namespace {

constexpr StoppingEntry kStoppingTests[] = {
    {"relative",
     "no body's acceleration is corrected by more than the tolerance times the root mean square of all, gravity at "
     "least",
     Stopping::relative},
    {"correction", "the original study's: the 2-norm of the correction of (a, λ) is below the tolerance",
     Stopping::correction},
};

}  // namespace

Registry<StoppingEntry>& stopping_tests() {
  static Registry<StoppingEntry> table("stopping test", kStoppingTests);
  return table;
}

}  // namespace poinsot
