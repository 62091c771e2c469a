#include "integrators/start/regular_beside.h"

#include <algorithm>
#include <random>
#include <vector>

#include "core/body_sizes.h"
#include "core/index.h"
#include "core/so3.h"
#include "formulations/registry.h"
#include "integrators/start/rank.h"
#include "integrators/start/rough_pose.h"
#include "integrators/start/row_space.h"
#include "integrators/stepping/singular_position.h"

namespace poinsot {
namespace {

constexpr int kTries = 6;
constexpr double kMoved = 0.05;  // of a body's size, and rad
// What is left of a row beside the others where it is singular: constraints that touch are closed to the root of
// rounding only.
constexpr double kSingularShare = 1e-4;

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
  const bool driven = std::ranges::any_of(model->rows, [](const Row& row) { return !row.f.is_constant(); });
  if (driven || states.size() > kMostClosed) return true;
  const std::vector<double> sizes = body_sizes(*model);
  std::mt19937 random(1);
  std::uniform_real_distribution<double> by(-kMoved, kMoved);
  const auto along = [&] { return Vector3(by(random), by(random), by(random)); };
  bool any = false;
  for (int k = 0; k < kTries; ++k) {
    std::vector<BodyState> moved(states.begin(), states.end());
    for (std::size_t b = 0; b < moved.size(); ++b) {
      moved[b].r += sizes[b] * along();
      moved[b].A = exp_so3<double>(along()) * moved[b].A;
    }
    const ClosedPose pose = close_mechanism(*model, moved);
    if (!pose.closed) continue;
    if (is_regular(model, pose.states)) return true;
    any = true;
  }
  return !any;
}

}  // namespace poinsot
