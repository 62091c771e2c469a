#include "integrators/start/reactions.h"

#include <Eigen/QR>

#include "formulations/gradient.h"
#include "formulations/registry.h"

namespace poinsot {
namespace {

// Gᵀ of the rows without rp's normalization, dense: mechanisms with dependent rows are small.
Eigen::MatrixXd transposed_gradient(Problem& problem) {
  Eigen::MatrixXd Gt = Eigen::MatrixXd::Zero(problem.nv(), problem.nc());
  for (const auto& entry : gradient(problem)) Gt(entry.col(), entry.row()) += entry.value();
  return Gt;
}

// Pivots below this, of the largest, are those of dependent rows. Rows depend on one another where the constraints
// hold; in a computed state they do but for an integrator's tolerance.
constexpr double kDependent = 1e-8;

}  // namespace

Reactions::Reactions(const Problem& problem) : lambda_(problem.model().rows.size()) {
  if (problem.model_rows().size() == lambda_.size()) return;
  const auto model = std::make_shared<const Model>(problem.model());
  whole_ = intrinsic_formulation().make(model, {});
  q_.resize(static_cast<std::size_t>(whole_->nq()));
  v_.resize(static_cast<std::size_t>(whole_->nv()));
}

void Reactions::update(const Sample& sample) {
  problem_ = &sample.problem;
  const std::vector<int>& rows = problem_->model_rows();
  if (!whole_) {
    std::copy_n(sample.lambda.begin(), lambda_.size(), lambda_.begin());
    return;
  }
  std::vector<BodyState> states(static_cast<std::size_t>(problem_->bodies()));
  problem_->to_bodies(sample.a, states);
  if (!whole_->from_bodies(states, q_, v_).ok()) return;
  whole_->set_position(sample.t, q_);
  whole_->set_velocity(v_);
  const Eigen::MatrixXd Gt = transposed_gradient(*whole_);
  Eigen::VectorXd determined = Eigen::VectorXd::Zero(Gt.cols());
  for (std::size_t k = 0; k < rows.size(); ++k) determined[rows[k]] = sample.lambda[k];
  Eigen::CompleteOrthogonalDecomposition<Eigen::MatrixXd> decomposition;
  decomposition.setThreshold(kDependent);
  decomposition.compute(Gt);
  const Eigen::VectorXd least = decomposition.solve(Gt * determined);
  std::copy(least.begin(), least.end(), lambda_.begin());
}

void Reactions::of_group(int group, Vector3& force, Vector3& moment) const {
  (whole_ ? *whole_ : *problem_).reaction(group, lambda_, force, moment);
}

}  // namespace poinsot
