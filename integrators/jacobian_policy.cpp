#include "integrators/jacobian_policy.h"

namespace poinsot {
namespace {

constexpr JacobianEntry kJacobians[] = {
    {"exact", "the full Newton matrix, made anew in every iteration", MatrixKind::exact, Refresh::every_iteration},
    {"simplified",
     "the original study's: no variation of reactions, factored once, where the last step ended; no predictor",
     MatrixKind::simplified, Refresh::before_step},
    {"kept", "the full Newton matrix, kept while it converges well, over iterations and steps", MatrixKind::exact,
     Refresh::when_slow},
};

}  // namespace

bool due(Refresh refresh, int k, bool worn) {
  switch (refresh) {
    case Refresh::every_iteration:
      return true;
    case Refresh::every_step:
    case Refresh::before_step:
      return k == 0;
    case Refresh::when_slow:
      return worn;
  }
  return true;
}

Registry<JacobianEntry>& jacobians() {
  static Registry<JacobianEntry> table("jacobian", kJacobians);
  return table;
}

}  // namespace poinsot
