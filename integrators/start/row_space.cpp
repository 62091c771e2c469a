#include "integrators/start/row_space.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

#include "core/body_sizes.h"
#include "core/check.h"
#include "core/index.h"
#include "formulations/registry.h"

namespace poinsot {

RowSpace::RowSpace(std::shared_ptr<const Model> model, std::vector<int> rows, Use use)
    : model_(std::move(model)),
      rows_(std::move(rows)),
      use_(use),
      problem_(intrinsic_formulation().make(model_, all_but(model_->rows.size(), rows_))),
      place_(rows_.size()),
      sizes_(body_sizes(*model_)),
      own_sizes_(poinsot::own_sizes(*model_)),
      q_(index(problem_->nq())),
      v_(index(problem_->nv())),
      lengths_(rows_.size()),
      weights_(rows_.size(), 1),
      vanishing_(rows_.size(), 1),
      of_problem_(rows_.size()) {
  std::iota(place_.begin(), place_.end(), 0);
  check(layout_.build(problem_->pattern(MatrixKind::kinematic)).ok(), "an assembled matrix fits 32-bit indices");
  values_.resize(index(layout_.nonzeros()));
  const int nc = problem_->nc();
  const auto visit = [&](auto&& entry) {
    for (int j = 0; j < problem_->nv(); ++j)
      for (int k = layout_.start[index(j)]; k < layout_.start[index(j + 1)]; ++k)
        if (layout_.row[index(k)] < nc) entry(k, layout_.row[index(k)], j);
  };
  // Columns j are visited ascending, and so are the entries of a row of G in its column of Gᵀ.
  Gt_.resize(problem_->nv(), nc);
  std::vector<int> next(index(nc) + 1, 0);
  visit([&](int, int row, int) { ++next[index(row) + 1]; });
  std::partial_sum(next.begin(), next.end(), Gt_.outerIndexPtr());
  Gt_.resizeNonZeros(Gt_.outerIndexPtr()[nc]);
  std::copy_n(Gt_.outerIndexPtr(), next.size(), next.begin());
  source_.resize(index(Gt_.nonZeros()));
  measure_.assign(source_.size(), 1);
  visit([&](int k, int row, int j) {
    const int at = next[index(row)]++;
    source_[index(at)] = k;
    if (j % 6 >= 3) measure_[index(at)] = 1 / sizes_[index(j / 6)];
    Gt_.innerIndexPtr()[at] = j;
  });
  for (const int k : rows_) {
    const Row& row = model_->rows[index(k)];
    const bool of_directions = row.type == RowType::DP1 || row.type == RowType::angle;
    rounding_.push_back(of_directions ? kDependent * direction_terms(row) : 0);
    if (row.type == RowType::D) at_.resize(sizes_.size());
  }
}

void RowSpace::stand(double t, std::span<const BodyState> states) {
  for (std::size_t k = 0; k < rows_.size(); ++k) weights_[k] = weight_of(k, states);
  problem_->from_bodies(states, q_, v_);
  stand_at(t, q_);
}

void RowSpace::move(double t, std::span<const double> q) {
  problem_->set_position(t, q);
}

void RowSpace::stand_at(double t, std::span<const double> q) {
  std::ranges::fill(v_, 0.0);
  problem_->set_position(t, q);
  problem_->set_velocity(v_);
  if (!at_.empty()) problem_->to_bodies(v_, at_);
  problem_->assemble(MatrixKind::kinematic, {}, {}, {}, {}, layout_.slots, values_);
  for (int k = 0; k < Gt_.outerSize(); ++k) {
    const int begin = Gt_.outerIndexPtr()[k], end = Gt_.outerIndexPtr()[k + 1];
    double* g = Gt_.valuePtr();
    double sum = 0;
    for (int i = begin; i < end; ++i) {
      g[i] = values_[index(source_[index(i)])] * measure_[index(i)];
      sum += g[i] * g[i];
    }
    const double rounding = rounding_of(index(k));
    const double norm = std::max(std::sqrt(sum), rounding);
    if (use_ == Use::choice) vanishing_[index(k)] = std::clamp(full_norm(index(k)) / norm, 1.0, kVelocityRow);
    lengths_[index(k)] = weights_[index(k)] * vanishing_[index(k)] * norm;
    const double by = sum > rounding * rounding ? 1 / lengths_[index(k)] : 0;
    for (int i = begin; i < end; ++i) g[i] *= by;
  }
}

void RowSpace::keep(std::vector<int> rows) {
  Eigen::SparseMatrix<double> left(Gt_.rows(), static_cast<Eigen::Index>(rows.size()));
  left.reserve(Gt_.nonZeros());
  std::size_t k = 0, entries = 0;
  for (std::size_t c = 0; c < rows.size(); ++c, ++k) {
    while (rows_[k] != rows[c]) ++k;
    left.startVec(static_cast<Eigen::Index>(c));
    for (int i = Gt_.outerIndexPtr()[k]; i < Gt_.outerIndexPtr()[k + 1]; ++i, ++entries) {
      left.insertBack(Gt_.innerIndexPtr()[i], static_cast<Eigen::Index>(c)) = Gt_.valuePtr()[i];
      source_[entries] = source_[index(i)], measure_[entries] = measure_[index(i)];
    }
    place_[c] = place_[k], lengths_[c] = lengths_[k], weights_[c] = weights_[k], rounding_[c] = rounding_[k];
    vanishing_[c] = vanishing_[k];
  }
  left.finalize();
  Gt_ = std::move(left);
  source_.resize(entries), measure_.resize(entries);
  for (std::vector<double>* of : {&lengths_, &weights_, &rounding_, &vanishing_}) of->resize(rows.size());
  place_.resize(rows.size());
  rows_ = std::move(rows);
}

double RowSpace::weight_of(std::size_t k, std::span<const BodyState> states) const {
  const Row& row = model_->rows[index(rows_[k])];
  double far = 0;
  for (const int body : {row.i, row.j})
    if (body != kGround) far = std::max(far, states[index(body)].r.norm() / sizes_[index(body)]);
  const double rounding = kRoundings * std::numeric_limits<double>::epsilon() * far / kDependent;
  return (is_velocity_row(k) ? kVelocityRow : 1) * std::clamp(rounding, 1.0, kFarthest);
}

// Of the cross product of two directions.
double RowSpace::direction_terms(const Row& row) const {
  double size = 0;
  for (const int body : {row.i, row.j})
    if (body != kGround) size = std::max(size, 1 / sizes_[index(body)]);
  return row.a_i.norm() * row.a_j.norm() * size;
}

// Where a gradient can cancel altogether, kDependent of the terms it is made of: the cross product of directions that
// are parallel, the distance of points that coincide.
double RowSpace::rounding_of(std::size_t k) const {
  const Row& row = model_->rows[index(rows_[k])];
  if (row.type != RowType::D) return rounding_[k];
  const auto place = [&](int body, const Vector3& s) {
    return s.norm() + (body == kGround ? 0.0 : at_[index(body)].r.norm());
  };
  return kDependent * 2 * (place(row.i, row.s_i) + place(row.j, row.s_j));
}

double RowSpace::left_of(std::size_t k) const {
  const Row& row = model_->rows[index(rows_[k])];
  double terms = 0;
  if (row.type == RowType::DP1) terms = direction_terms(row);
  if (row.type == RowType::D) {  // of points, where its bodies are does not matter
    for (const int body : {row.i, row.j})
      if (body != kGround) terms = std::max(terms, 2 * (body == row.i ? row.s_i : row.s_j).norm());
  }
  return terms > 0 ? std::min(1.0, norm_of_row(k) / terms) : 1;
}

double RowSpace::full_norm(std::size_t k) const {
  const Row& row = model_->rows[index(rows_[k])];
  return row.type == RowType::DP1 ? direction_terms(row) : row.type == RowType::D ? own_size_of_row(k) : 0;
}

// What the problem has of its rows, of those that are kept.
void RowSpace::take_places(std::span<double> out) const {
  for (std::size_t k = 0; k < out.size(); ++k) out[k] = of_problem_[index(place_[k])];
}

void RowSpace::distances(std::span<double> out) const {
  problem_->position_residual(of_problem_);
  take_places(out);
  for (std::size_t k = 0; k < out.size(); ++k)
    if (out[k] != 0) out[k] /= norm_of_row(k);  // 0 also where the gradient has vanished
}

void RowSpace::rates(std::span<const double> v, std::span<double> residual, std::span<double> nu) {
  problem_->set_velocity(v);
  problem_->velocity_residual(of_problem_);
  take_places(residual);
  problem_->nu(of_problem_);
  take_places(nu);
}

double RowSpace::largest_of_row(std::size_t k, const std::vector<double>& sizes) const {
  const Row& row = model_->rows[index(rows_[k])];
  double size = 0;
  for (const int body : {row.i, row.j})
    if (body != kGround) size = std::max(size, sizes[index(body)]);
  return size;
}

}  // namespace poinsot
