#include "integrators/start/rows_aside.h"

#include <algorithm>
#include <array>
#include <functional>
#include <iterator>
#include <utility>

#include "core/index.h"
#include "formulations/registry.h"

namespace poinsot {
namespace {

// All that a row says.
struct Words {
  RowType type;
  int i, j;
  bool squared;
  std::array<double, 19> numbers;
  explicit Words(const Row& row) : type(row.type), i(row.i), j(row.j), squared(row.squared) {
    auto to = numbers.begin();
    for (const Vector3* part : {&row.a_i, &row.b_i, &row.a_j, &row.s_i, &row.s_j, &row.c})
      to = std::copy_n(part->data(), 3, to);
    *to = row.f.at(0.0).f;
  }
  auto operator<=>(const Words&) const = default;
};

}  // namespace

std::vector<int> not_said_twice(const Model& model, const std::vector<int>& aside, const std::vector<int>& kept) {
  const auto row = [&](int k) -> const Row& { return model.rows[index(k)]; };
  const auto is_plain = [&](int k) { return row(k).f.is_constant() && !row(k).alternate; };
  std::vector<std::pair<Words, int>> said;  // by rows of `aside`
  for (const int k : aside)
    if (is_plain(k)) said.emplace_back(Words(row(k)), k);
  std::ranges::sort(said, std::less());
  std::vector<int> twice, once;
  for (const int k : kept) {
    if (!is_plain(k)) continue;
    const Words words(row(k));
    auto at = std::ranges::lower_bound(said, words, std::less(), &std::pair<Words, int>::first);
    for (; at != said.end() && at->first == words; ++at) twice.push_back(at->second);
  }
  std::ranges::sort(twice);
  std::ranges::set_difference(aside, twice, std::back_inserter(once));
  return once;
}

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
  q_.resize(index(problem_->nq())), v_.resize(index(problem_->nv())), residual_.resize(rows_.size());
}

std::span<const double> RowsAside::position_residual(double t, const Problem& of_model) {
  of_model.poses(body_, q_);
  problem_->set_position(t, q_);
  problem_->position_residual(residual_);
  return residual_;
}

std::span<const double> RowsAside::velocity_residual(std::span<const BodyState> of_model) {
  Eigen::Map<Eigen::Matrix<double, 6, Eigen::Dynamic>> v(v_.data(), 6, static_cast<Eigen::Index>(body_.size()));
  for (std::size_t k = 0; k < body_.size(); ++k) {
    const BodyState& state = of_model[index(body_[k])];
    v.col(static_cast<Eigen::Index>(k)) << state.rd, state.w;
  }
  problem_->set_velocity(v_);
  problem_->velocity_residual(residual_);
  return residual_;
}

}  // namespace poinsot
