#include "integrators/jacobian_policy.h"

#include <algorithm>
#include <iterator>

namespace poinsot {
namespace {

constexpr JacobianEntry kJacobians[] = {
    {"exact", "the full Newton matrix, made anew in every iteration", MatrixKind::exact, Refresh::every_iteration},
    {"simplified",
     "the original study's: no variation of reactions, factored once, where the last step ended; no predictor",
     MatrixKind::simplified, Refresh::before_step},
    {"kept", "the full Newton matrix, kept while it converges well, over iterations and steps (not in kinematics)",
     MatrixKind::exact, Refresh::when_slow},
};

}  // namespace

std::span<const JacobianEntry> jacobians() {
  return kJacobians;
}

const JacobianEntry* find_jacobian(std::string_view name) {
  const auto at = std::find_if(std::begin(kJacobians), std::end(kJacobians),
                               [&](const JacobianEntry& entry) { return entry.name == name; });
  return at == std::end(kJacobians) ? nullptr : at;
}

}  // namespace poinsot
