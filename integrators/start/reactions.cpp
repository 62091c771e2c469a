#include "integrators/start/reactions.h"

#include <Eigen/Cholesky>
#include <Eigen/SparseCholesky>
#include <algorithm>

#include "core/index.h"
#include "formulations/registry.h"
#include "integrators/start/loop_rows.h"

namespace poinsot {

Reactions::Reactions(const Problem& problem) : lambda_(problem.model().rows.size()) {
  if (problem.model_rows().size() == lambda_.size()) return;
  whole_ = intrinsic_formulation().make(std::make_shared<const Model>(problem.model()), {});
  q_.resize(index(whole_->nq()));
  v_.resize(index(whole_->nv()));
  states_.resize(index(problem.bodies()));
}

void Reactions::update(const Sample& sample) {
  problem_ = &sample.problem;
  if (!whole_) {
    std::copy_n(sample.lambda.begin(), lambda_.size(), lambda_.begin());
    return;
  }
  problem_->to_bodies(sample.a, states_);
  whole_->from_bodies(states_, q_, v_);
  whole_->set_position(sample.t, q_);
  whole_->set_velocity(v_);
  if (!choice_ || revision_ != problem_->revision()) {
    revision_ = problem_->revision();
    const auto model = std::make_shared<const Model>(problem_->model());
    choice_.emplace(model, loop_rows(model, sample.t, states_), all_but(lambda_.size(), problem_->model_rows()));
  }
  std::ranges::fill(lambda_, 0.0);
  const std::vector<int>& rows = problem_->model_rows();
  for (std::size_t k = 0; k < rows.size(); ++k) lambda_[index(rows[k])] = sample.lambda[k];
  null_vectors_ = choice_->null_vectors(sample.t, states_);
  least_ = null_vectors_.size() == choice_->aside().size();
  if (null_vectors_.empty()) return;  // as they are
  make_least();
}

void Reactions::make_least() {
  std::vector<Eigen::Triplet<double>> entries;
  for (std::size_t k = 0; k < null_vectors_.size(); ++k)
    for (const auto& [row, value] : null_vectors_[k]) entries.emplace_back(row, static_cast<int>(k), value);
  Eigen::SparseMatrix<double> N(static_cast<Eigen::Index>(lambda_.size()),
                                static_cast<Eigen::Index>(null_vectors_.size()));
  N.setFromTriplets(entries.begin(), entries.end());
  Eigen::Map<Eigen::VectorXd> lambda(lambda_.data(), N.rows());
  const Eigen::SparseMatrix<double> square = N.transpose() * N;
  const Eigen::SimplicialLDLT<Eigen::SparseMatrix<double>> factors(square);
  for (int pass = 0; pass < 2; ++pass) {  // the second takes out the rounding of the first
    const Eigen::VectorXd part = factors.solve(N.transpose() * lambda);
    lambda -= N * part;
  }
}

std::vector<Undetermined> Reactions::undetermined() const {
  if (!whole_) return {};
  return undetermined_by(null_vectors_, !least_, problem_->model(), choice_->space(), states_);
}

std::vector<int> Reactions::may_be_undetermined() const {
  return whole_ ? choice_->groups_of_redundant_loops(problem_->model()) : std::vector<int>();
}

void Reactions::of_group(int group, Vector3& force, Vector3& moment) const {
  (whole_ ? *whole_ : *problem_).reaction(group, lambda_, force, moment);
}

}  // namespace poinsot
