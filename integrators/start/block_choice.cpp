#include "integrators/start/block_choice.h"

#include <Eigen/SparseCholesky>
#include <algorithm>
#include <cmath>
#include <random>
#include <utility>

#include "core/index.h"
#include "linsolve/column_dependencies.h"

namespace poinsot {
namespace {

using Sparse = Eigen::SparseMatrix<double>;

// Coefficient at which rows are chosen anew, and as large as it may become. Two directions at right angles of which one
// is set aside have the coefficient cot α when the redundant one is α from the row that is kept in its place. Of two
// bodies that turn against one another α changes by kTurnsMost what each turns; as a rule much less: after a look by no
// more than kTurnsMore times what it changed by since the one before, but by kTurnsLittle.
constexpr double kWorn = 6, kWorst = 20;
constexpr double kTurnsMost = 2, kTurnsLittle = 1, kTurnsMore = 3;
constexpr double kNothing = 1e-12;  // of a coefficient beside the row set aside
constexpr std::size_t kMostCoefficients = 4'000'000;
constexpr double kMostProducts = 2e7;
constexpr double kGain = 2;  // times better is a choice that is worth an exchange

double angle(double coefficient) {
  return std::atan(1 / coefficient);
}
double turn_until_worst(double coefficient, double rate) {
  constexpr double kLeast = 0.05;
  return std::max((angle(coefficient) - angle(kWorst)) / rate, kLeast);
}

}  // namespace

BlockChoice::BlockChoice(const Model& model, const RowSpace& space, std::vector<int> rows,
                         const std::vector<int>& aside)
    : rows_(space, std::move(rows)), watched_(rows_.products() <= kMostProducts) {
  std::vector<int> left_out;
  for (int k = 0; k < static_cast<int>(rows_.size()); ++k) {
    const int row = row_of(space, k);
    group_.push_back(model.rows[index(row)].group);
    if (std::ranges::binary_search(aside, row)) left_out.push_back(k);
  }
  keep_others(left_out);
  if (kept_.size() <= SmallCoefficients::kMost) small_.emplace(model, space, rows_);
}

int BlockChoice::row_of(const RowSpace& space, int k) const {
  return space.rows()[index(rows_.place_in_space(k))];
}

void BlockChoice::keep_others(const std::vector<int>& left_out) {
  left_out_ = left_out;
  kept_ = others(left_out);
}

std::vector<int> BlockChoice::others(const std::vector<int>& left_out) const {
  std::vector<int> kept;
  for (int k = 0; k < static_cast<int>(rows_.size()); ++k)
    if (!std::ranges::binary_search(left_out, k)) kept.push_back(k);
  return kept;
}

bool BlockChoice::large() const {
  return left_out_.size() > kMost || left_out_.size() * kept_.size() > kMostCoefficients;
}

bool BlockChoice::find_coefficients(const RowSpace& space) {
  if (small_ ? small_->find(space, rows_, kept_, left_out_, C_) : find_sparse(space)) return true;
  C_.setZero(static_cast<Eigen::Index>(kept_.size()), static_cast<Eigen::Index>(left_out_.size()));
  return false;
}

bool BlockChoice::find_sparse(const RowSpace& space) {
  const Sparse K = rows_.columns(space, kept_), D = rows_.columns(space, left_out_);
  const Eigen::SimplicialLDLT<Sparse> gram(K.transpose() * K);
  if (gram.info() != Eigen::Success) return false;
  C_ = gram.solve(Eigen::MatrixXd(K.transpose() * D));
  const Eigen::MatrixXd left = Eigen::MatrixXd(D) - K * C_;
  C_ += gram.solve(K.transpose() * left);
  return C_.allFinite();
}

std::vector<SparseEntries> BlockChoice::unit_null_vectors() const {
  std::vector<SparseEntries> vectors(left_out_.size());
  for (std::size_t d = 0; d < left_out_.size(); ++d) {
    for (std::size_t k = 0; k < kept_.size(); ++k) {
      const double c = C_(static_cast<Eigen::Index>(k), static_cast<Eigen::Index>(d));
      if (std::abs(c) > kNothing) vectors[d].emplace_back(kept_[k], -c);
    }
    vectors[d].emplace_back(left_out_[d], 1.0);
    std::ranges::sort(vectors[d]);
  }
  return vectors;
}

void BlockChoice::look(const RowSpace& space) {
  if (!watched_) {
    good_for_ = HUGE_VAL;
    return;
  }
  if (large())
    worst_ = estimate(space, left_out_);
  else
    worst_ = find_coefficients(space) ? C_.cwiseAbs().maxCoeff() : HUGE_VAL;
  good_for_ = turn_until_worst(worst_, kTurnsMost);
}

bool BlockChoice::worn() const {
  return worst_ > kWorn;
}

bool BlockChoice::renew(const RowSpace& space, double turned) {
  if (!watched_) return false;
  const double before = angle(worst_);
  const bool sums = !small_ && !large();
  if (sums)
    worst_ = estimate(space, left_out_);
  else
    look(space);
  if (sums && worn()) look(space);
  if (!worn()) {
    const double rate = kTurnsMore * std::abs(angle(worst_) - before) / turned;
    good_for_ = turn_until_worst(worst_, std::clamp(rate, kTurnsLittle, kTurnsMost));
    return false;
  }
  return large() || !std::isfinite(worst_) ? choose_clearest(space) : exchange(space);
}

bool BlockChoice::exchange(const RowSpace& space) {
  if (small_) small_->refine(kept_, left_out_, C_);
  std::vector<int> chosen = left_out_;
  repair(unit_null_vectors(), chosen, group_);
  std::ranges::sort(chosen);
  if (chosen == left_out_) return false;
  keep_others(chosen);
  look(space);
  if (small_) small_->refine(kept_, left_out_, C_);
  return true;
}

bool BlockChoice::choose_clearest(const RowSpace& space) {
  std::vector<int> chosen = clearest(space);
  if (chosen.size() != left_out_.size() || !(kGain * estimate(space, chosen) < worst_)) return false;
  keep_others(chosen);
  look(space);
  return true;
}

// About the largest coefficient: half of the largest √(Σ_d c_kd²), by three sums with random signs.
double BlockChoice::estimate(const RowSpace& space, const std::vector<int>& left_out) const {
  constexpr Eigen::Index kVectors = 3;
  const Sparse K = rows_.columns(space, others(left_out)), D = rows_.columns(space, left_out);
  const Eigen::SimplicialLDLT<Sparse> gram(K.transpose() * K);
  if (gram.info() != Eigen::Success) return HUGE_VAL;
  std::mt19937 random(1);
  const Eigen::MatrixXd signs =
      Eigen::MatrixXd::NullaryExpr(D.cols(), kVectors, [&] { return random() % 2 == 0 ? 1.0 : -1.0; });
  const Eigen::MatrixXd sums = gram.solve(K.transpose() * (D * signs));
  return sums.allFinite() ? std::sqrt(sums.rowwise().squaredNorm().maxCoeff() / kVectors) / 2 : HUGE_VAL;
}

std::vector<int> BlockChoice::clearest(const RowSpace& space) const {
  return clearest_dependent_columns(rows_.columns(space, others({})), kIndependent);
}

void BlockChoice::add_aside(const RowSpace& space, std::vector<int>& rows) const {
  for (const int k : left_out_) rows.push_back(row_of(space, k));
}

void BlockChoice::carry_over(const RowSpace& space, std::span<double> lambda) const {
  const auto at = [&](int k) -> double& { return lambda[index(row_of(space, k))]; };
  const auto length = [&](int k) { return space.lengths()[index(rows_.place_in_space(k))]; };
  Eigen::VectorXd forces(static_cast<Eigen::Index>(left_out_.size()));
  for (std::size_t d = 0; d < left_out_.size(); ++d)
    forces[static_cast<Eigen::Index>(d)] = std::exchange(at(left_out_[d]), 0.0) * length(left_out_[d]);
  Eigen::VectorXd shares;  // of the kept rows
  if (large()) {
    const Sparse K = rows_.columns(space, kept_);
    const Eigen::VectorXd all = rows_.columns(space, left_out_) * forces;
    const Eigen::SimplicialLDLT<Sparse> gram(K.transpose() * K);
    shares = gram.solve(K.transpose() * all);
    shares += gram.solve(K.transpose() * (all - K * shares));
  } else {
    shares = C_ * forces;
  }
  for (std::size_t k = 0; k < kept_.size(); ++k)
    at(kept_[k]) += shares[static_cast<Eigen::Index>(k)] / length(kept_[k]);
}

void BlockChoice::add_null_vectors(const RowSpace& space, std::vector<SparseEntries>& vectors) {
  if (!watched_ || large() || !find_coefficients(space)) return;
  if (small_) small_->refine(kept_, left_out_, C_);
  for (SparseEntries& z : unit_null_vectors()) {
    for (auto& [k, value] : z) {
      value /= space.lengths()[index(rows_.place_in_space(k))];
      k = row_of(space, k);
    }
    vectors.push_back(std::move(z));
  }
}

}  // namespace poinsot
