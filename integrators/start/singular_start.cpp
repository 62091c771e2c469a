#include "integrators/start/singular_start.h"

#include <algorithm>

#include "core/index.h"
#include "integrators/stepping/consistent.h"
#include "integrators/stepping/vectors.h"

namespace poinsot {
namespace {

// ½ (a(s) + a(−s))
Status mean_beside(Problem& problem, const Settings& settings, const State& state, double s, Eigen::VectorXd& mean) {
  Consistent consistent(problem, settings.linear());
  mean.setZero(state.v.size());
  for (const double time : {s, -s}) {
    State beside = state;
    beside.t = state.t + time;
    Eigen::VectorXd dq = time * state.v;
    problem.retract(span(state.q), span(dq), span(beside.q));
    if (Status status = consistent.project_position(beside.t, span(beside.q)); !status.ok()) return status;
    consistent.stand(beside);
    if (Status status = consistent.project_velocity(beside.t, span(beside.v)); !status.ok()) return status;
    if (Status status = consistent.accelerations(beside); !status.ok()) return status;
    mean += 0.5 * beside.z.head(state.v.size());
  }
  return {};
}

}  // namespace

Status limit_accelerations(Problem& problem, const RankAnalysis& rank, const Settings& settings, State& state) {
  const Eigen::Index nv = state.v.size();
  Eigen::VectorXd near, far;
  if (Status status = mean_beside(problem, settings, state, rank.time_beside, near); !status.ok()) return status;
  if (Status status = mean_beside(problem, settings, state, 2 * rank.time_beside, far); !status.ok()) return status;
  state.z.setZero();
  state.z.head(nv) = (4 * near - far) / 3;

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

}  // namespace poinsot
