#include "integrators/start/regular_beside.h"

#include <optional>
#include <vector>

#include "core/index.h"
#include "formulations/registry.h"
#include "integrators/start/closed_beside.h"
#include "integrators/start/rank.h"
#include "integrators/start/row_space.h"
#include "integrators/stepping/singular_position.h"

namespace poinsot {
namespace {

constexpr int kTries = 6;
// What is left of a row beside the others where it is singular: constraints that touch are closed to the root of
// rounding only.
constexpr double kSingularShare = 1e-5;

bool is_regular(const std::shared_ptr<const Model>& model, std::span<const BodyState> states) {
  const RankAnalysis rank = analyze_rank(model, states, RankNames::none);
  if (rank.singular_position()) return false;
  const std::unique_ptr<Problem> problem = intrinsic_formulation().make(model, rank.aside);
  std::vector<double> q(index(problem->nq())), v(index(problem->nv()));
  problem->from_bodies(states, q, v);
  return most_dependent_row(*problem, problem->nc(), 0, q).share > kSingularShare;
}

}  // namespace

bool has_regular_positions_beside(const std::shared_ptr<const Model>& model, std::span<const BodyState> states) {
  ClosedBeside beside(*model, states);
  if (!beside.can_be_found()) return true;
  bool any = false;
  for (int k = 0; k < kTries; ++k) {
    const std::optional<std::vector<BodyState>> closed = beside.next();
    if (!closed) continue;
    if (is_regular(model, *closed)) return true;
    any = true;
  }
  return !any;
}

}  // namespace poinsot
