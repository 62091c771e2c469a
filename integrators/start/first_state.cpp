#include "integrators/start/first_state.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "core/index.h"
#include "integrators/stepping/accept.h"
#include "integrators/stepping/consistent.h"
#include "integrators/stepping/passage.h"
#include "integrators/stepping/vectors.h"

namespace poinsot {
namespace {

// Of the largest velocity, by which the velocities of the branch may differ: rounding beside the position.
constexpr double kOnBranch = 1e-5;

// Accelerations and multipliers of a start in a singular position that the velocities lead through.
//
// There G has lost rank: rows that are independent on either side leave accelerations open. On the branch of the motion
// these are smooth: they are the limit of those beside (stepping/passage.h). The multipliers, which may grow without
// bound towards the position, are those of the rows independent in it that fit M a + Gᵀλ = Q.
Status limit_accelerations(Problem& problem, const RankAnalysis& rank, const Settings& settings, State& state) {
  // times the time after which velocities have led a thousandth of the bodies' sizes away: the farther, the less
  // rounding
  constexpr std::array kFarther{15.0, 5.0, 1.0};
  Consistent beside(problem, settings.linear());
  Passage passage(problem, beside);
  State limit = state;
  const bool found = std::ranges::any_of(
      kFarther, [&](double farther) { return passage.limit(limit, state.v, farther * rank.time_beside, HUGE_VAL); });
  const auto singular = [&] { return describe_row(problem.model(), rank.singular.front().row); };
  if (!found) {
    return {Failure::singular_position, state.t,
            fmt::format("the initial pose is a singular position of the mechanism, and accelerations beside it have no "
                        "limit there: singular here: {}; start beside it",
                        singular())};
  }
  // The constraints leave more velocities free than the mechanism has on either side.
  const Eigen::VectorXd off = limit.v - state.v;
  if (!(largest(span(off)) <= kOnBranch * largest(span(state.v)))) {
    return {Failure::singular_position, state.t,
            fmt::format("the initial pose is a singular position of the mechanism, and the initial velocities are on "
                        "none of the branches that go through it: singular here: {}; start beside it, or with the "
                        "velocities of one branch",
                        singular())};
  }
  const Eigen::Index nv = state.v.size();
  state.z.setZero();
  state.z.head(nv) = limit.z.head(nv);

  const std::unique_ptr<Problem> independent = problem.clone_without(rank.aside_here);
  independent->set_position(state.t, span(state.q));
  independent->set_velocity(span(state.v));
  Eigen::VectorXd forces = Eigen::VectorXd::Zero(nv + independent->nc());
  const Eigen::VectorXd none = Eigen::VectorXd::Zero(independent->nc());
  independent->equations_of_motion(state.a(), span(none), span(forces, 0, nv));
  forces = -forces;
  Consistent consistent(*independent, settings.linear());
  if (Status status = consistent.factor(state.t); !status.ok()) return status;
  if (Status status = consistent.solve(state.t, span(forces)); !status.ok()) return status;

  const std::vector<int>&all = problem.model_rows(), &some = independent->model_rows();
  for (std::size_t k = 0; k < some.size(); ++k) {
    const auto place = std::ranges::lower_bound(all, some[k]) - all.begin();
    state.lambda()[index(place)] = forces[nv + static_cast<Eigen::Index>(k)];
  }
  // Rows a formulation adds (rp's normalizations) come last in both.
  const std::size_t own = index(problem.nc()) - all.size();
  std::copy(forces.end() - static_cast<std::ptrdiff_t>(own), forces.end(),
            state.lambda().end() - static_cast<std::ptrdiff_t>(own));
  problem.set_position(state.t, span(state.q));
  problem.set_velocity(span(state.v));
  return {};
}

}  // namespace

Status find_first_state(const InitialState& initial, const Settings& settings, Problem& problem, State& state) {
  if (Status status = problem.from_bodies(initial.bodies, span(state.q), span(state.v)); !status.ok()) return status;
  if (settings.analysis == Analysis::kinematics) return {};  // which finds everything but q itself
  Consistent consistent(problem, settings.linear());
  consistent.stand(state);
  bool rewritten = false;
  if (Status status = accept(problem, state, rewritten); !status.ok()) return status;
  if (initial.rank.singular_position()) return limit_accelerations(problem, initial.rank, settings, state);
  return consistent.accelerations(state.t, span(state.z));
}

}  // namespace poinsot
