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
constexpr double kUnbalanced = 1e-5;  // of the largest load: more is not due to the limit's rounding

// Adds to the multipliers what those of the rows independent in the singular position can of M a + Gᵀλ − Q, and gives
// out what is left of it. The problem stands at the state.
Status fit_multipliers(Problem& problem, const RankAnalysis& rank, const Settings& settings, State& state,
                       std::span<double> off) {
  const Eigen::Index nv = state.v.size();
  const auto stand = [&](Problem& at) {
    at.set_position(state.t, span(state.q));
    at.set_velocity(span(state.v));
  };
  const std::unique_ptr<Problem> independent = problem.clone_without(rank.aside_here);
  stand(*independent);
  stand(problem);
  Eigen::VectorXd forces = Eigen::VectorXd::Zero(nv + independent->nc());
  problem.equations_of_motion(state.a(), state.lambda(), span(forces, 0, nv));
  forces = -forces;
  Consistent consistent(*independent, settings.linear());
  if (Status status = consistent.factor(state.t); !status.ok()) return status;
  if (Status status = consistent.solve(state.t, span(forces)); !status.ok()) return status;

  const std::vector<int>&all = problem.model_rows(), &some = independent->model_rows();
  for (std::size_t k = 0; k < some.size(); ++k) {
    const auto place = std::ranges::lower_bound(all, some[k]) - all.begin();
    state.lambda()[index(place)] += forces[nv + static_cast<Eigen::Index>(k)];
  }
  // Rows a formulation adds (rp's normalizations) come last in both.
  const Eigen::Index own = problem.nc() - static_cast<Eigen::Index>(all.size());
  state.z.tail(own) += forces.tail(own);
  problem.equations_of_motion(state.a(), state.lambda(), off);
  return {};
}

// Of the forces and M a, at least what it takes to turn the velocities within a body's size. The problem stands at the
// state.
double largest_load(Problem& problem, const State& state, double time_beside) {
  constexpr double kThousandth = 1e-3;  // of the bodies' sizes, which takes time_beside
  Eigen::VectorXd load(state.v.size());
  problem.equations_of_motion(std::vector<double>(index(load.size()), 0.0), {}, span(load));
  double most = largest(span(load));
  problem.momentum(state.a(), span(load));
  most = std::max(most, largest(span(load)));
  problem.momentum(span(state.v), span(load));
  return std::max(most, kThousandth * largest(span(load)) / time_beside);
}

// Accelerations and multipliers of a start in a singular position that the velocities lead through.
//
// There G has lost rank: rows that are independent on either side leave accelerations open. On the branch of the motion
// these are smooth: they are the limit of those beside (stepping/passage.h), and so are the multipliers where they have
// one. Where they grow without bound towards the position, they are those of the rows independent in it that come
// nearest to M a + Gᵀλ = Q.
Status limit_state(Problem& problem, const RankAnalysis& rank, const Settings& settings, State& state,
                   const Tell& tell) {
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
    const std::string fault = problem.fault();  // of a function that has no value before the start
    beside.stand(state);
    if (!fault.empty())
      return with_remedy(
          Failure::not_finite, state.t,
          fault + ": accelerations of a start in a singular position are the limit of those before it and after it",
          "start beside it, or change the function");
    return with_remedy(
        Failure::singular_position, state.t,
        fmt::format("the initial pose is a singular position of the mechanism, and accelerations beside it have no "
                    "limit there: singular here: {}",
                    singular()),
        "start beside it");
  }
  // The constraints leave more velocities free than the mechanism has on either side.
  const Eigen::VectorXd beside_v = limit.v - state.v;
  if (!(largest(span(beside_v)) <= kOnBranch * largest(span(state.v)))) {
    return with_remedy(
        Failure::singular_position, state.t,
        fmt::format("the initial pose is a singular position of the mechanism, and the initial velocities are on "
                    "none of the branches that go through it: singular here: {}",
                    singular()),
        "start beside it, or with the velocities of one branch");
  }
  state.z.setZero();
  state.z.head(limit.v.size()) = limit.z.head(limit.v.size());
  (void)passage.limit_multipliers(state);
  Eigen::VectorXd off(state.v.size());
  if (Status status = fit_multipliers(problem, rank, settings, state, span(off)); !status.ok()) return status;
  Eigen::Index most = 0;
  const double left = off.cwiseAbs().maxCoeff(&most);
  if (left > kUnbalanced * largest_load(problem, state, rank.time_beside)) {
    tell(
        fmt::format("at t = 0 s multipliers grow without bound towards the singular position: in it, they and the "
                    "reactions leave up to {:.2g} N or N m of the loads of {} unbalanced; a start beside it has none",
                    left, problem.describe_unknown(static_cast<int>(most))));
  }
  return {};
}

}  // namespace

Status find_first_state(const InitialState& initial, const Settings& settings, Problem& problem, State& state,
                        const Tell& tell) {
  problem.from_bodies(initial.bodies, span(state.q), span(state.v));
  if (settings.analysis == Analysis::kinematics) return {};  // which finds everything but q itself
  Consistent consistent(problem, settings.linear());
  consistent.stand(state);
  bool rewritten = false;
  if (Status status = accept(problem, state, rewritten); !status.ok()) return status;
  if (initial.rank.singular_position()) return limit_state(problem, initial.rank, settings, state, tell);
  return consistent.accelerations(state.t, span(state.z));
}

}  // namespace poinsot
