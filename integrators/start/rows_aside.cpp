#include "integrators/start/rows_aside.h"

#include <utility>

#include "core/index.h"
#include "formulations/registry.h"

namespace poinsot {

RowsAside::RowsAside(const Model& model, std::vector<int> rows) : rows_(std::move(rows)) {
  auto alone = std::make_shared<Model>();
  std::vector<int> numbers(model.bodies.size(), -1);
  const auto number = [&](int body) {
    if (body == kGround) return kGround;
    int& its = numbers[index(body)];
    if (its < 0) {
      its = static_cast<int>(body_.size());
      body_.push_back(body);
      alone->bodies.emplace_back();
    }
    return its;
  };
  for (const int k : rows_) {
    Row& row = alone->rows.emplace_back(model.rows[index(k)]);
    row.i = number(row.i), row.j = number(row.j);
  }
  problem_ = intrinsic_formulation().make(std::move(alone), {});
  states_.resize(body_.size());
  q_.resize(index(problem_->nq())), v_.resize(index(problem_->nv())), residual_.resize(rows_.size());
}

std::span<const double> RowsAside::position_residual(double t, const Problem& of_model) {
  of_model.poses(body_, q_);
  problem_->set_position(t, q_);
  problem_->position_residual(residual_);
  return residual_;
}

std::span<const double> RowsAside::velocity_residual(std::span<const BodyState> of_model) {
  for (std::size_t k = 0; k < body_.size(); ++k) states_[k] = of_model[index(body_[k])];
  problem_->from_bodies(states_, q_, v_);
  problem_->set_velocity(v_);
  problem_->velocity_residual(residual_);
  return residual_;
}

}  // namespace poinsot
