#include "integrators/start/row_choice.h"

#include <Eigen/SparseCholesky>
#include <algorithm>
#include <cmath>
#include <utility>

#include "core/index.h"
#include "integrators/start/small_cholesky.h"

namespace poinsot {
namespace {

using Sparse = Eigen::SparseMatrix<double>;

// Coefficient at which rows are chosen anew, and as large as it may become. Two directions at right angles of which one
// is set aside have the coefficient cot α when the redundant one is α from the row that is kept in its place. Of two
// bodies that turn against one another α changes by kTurnsMost what each turns; as a rule much less: after a look by no
// more than kTurnsMore times what it changed by since the one before, but by kTurnsLittle.
constexpr double kWorn = 6, kWorst = 20;
constexpr double kTurnsMost = 2, kTurnsLittle = 1, kTurnsMore = 3;
constexpr double kNothing = 1e-12;    // of a coefficient beside the row set aside
constexpr Eigen::Index kDense = 120;  // rows up to which full matrices are faster

double angle(double coefficient) {
  return std::atan(1 / coefficient);
}
double turn_until_worst(double coefficient, double rate) {
  constexpr double kLeast = 0.05;
  return std::max((angle(coefficient) - angle(kWorst)) / rate, kLeast);
}

}  // namespace

RowChoice::RowChoice(std::shared_ptr<const Model> model, std::vector<int> rows, std::vector<int> aside)
    : space_(model, std::move(rows)), aside_(std::move(aside)) {
  for (const int row : space_.rows()) group_.push_back(model->rows[index(row)].group);
  sort_rows();
  find_beside(*model);
}

void RowChoice::find_beside(const Model& model) {
  if (!dense()) return;
  const std::size_t n = space_.rows().size();
  beside_.resize(n);
  const auto row = [&](std::size_t k) -> const Row& { return model.rows[index(space_.rows()[k])]; };
  const auto share = [](const Row& a, const Row& b) {
    const auto acts_on = [&](int body) { return body != kGround && (body == b.i || body == b.j); };
    return acts_on(a.i) || acts_on(a.j);
  };
  for (std::size_t k = 0; k < n; ++k)
    for (std::size_t l = 0; l < n; ++l)
      if (share(row(k), row(l))) beside_[k].push_back(static_cast<int>(l));
}

void RowChoice::sort_rows() {
  kept_.clear(), left_out_.clear();
  for (int k = 0; k < static_cast<int>(space_.rows().size()); ++k)
    (std::ranges::binary_search(aside_, space_.rows()[index(k)]) ? left_out_ : kept_).push_back(k);
}

bool RowChoice::find_coefficients() {
  const auto n = static_cast<Eigen::Index>(kept_.size()), m = static_cast<Eigen::Index>(left_out_.size());
  if (aside_.size() <= kMost && (dense() ? find_dense() : find_sparse())) return true;
  C_.setZero(n, m);
  return false;
}

bool RowChoice::dense() const {
  return static_cast<Eigen::Index>(kept_.size()) <= kDense;
}

// The parts of a unit row on its bodies.
void RowChoice::take_parts() {
  const Sparse& columns = space_.columns();
  parts_.resize(space_.rows().size());
  for (std::size_t k = 0; k < parts_.size(); ++k) {
    Parts& of = parts_[k];
    of.body[0] = of.body[1] = -1;
    int at = -1;
    for (Sparse::InnerIterator it(columns, static_cast<Eigen::Index>(k)); it; ++it) {
      const int body = static_cast<int>(it.row()) / 6;
      if (at < 0 || of.body[at] != body) {
        of.body[++at] = body;
        of.part[at].setZero();
      }
      of.part[at][it.row() % 6] = it.value();
    }
  }
}

double RowChoice::dot(int k, int l) const {
  const Parts &a = parts_[index(k)], &b = parts_[index(l)];
  double sum = 0;
  for (int i = 0; i < 2 && a.body[i] >= 0; ++i)
    for (int j = 0; j < 2; ++j)
      if (a.body[i] == b.body[j]) sum += a.part[i].dot(b.part[j]);
  return sum;
}

bool RowChoice::find_dense() {
  const auto n = static_cast<Eigen::Index>(kept_.size()), m = static_cast<Eigen::Index>(left_out_.size());
  take_parts();
  place_.assign(parts_.size(), -1);
  for (Eigen::Index j = 0; j < n; ++j) place_[index(kept_[index(j)])] = static_cast<int>(j);
  gram_.resize(n, n), C_.setZero(n, m);
  const auto fill = [&](int k, Eigen::Index from, auto&& column) {
    for (const int l : beside_[index(k)]) {
      const int place = place_[index(l)];
      if (place >= from) column[place] = dot(k, l);
    }
  };
  for (Eigen::Index j = 0; j < n; ++j) {
    gram_.col(j).tail(n - j).setZero();
    fill(kept_[index(j)], j, gram_.col(j));
  }
  for (Eigen::Index d = 0; d < m; ++d) fill(left_out_[index(d)], 0, C_.col(d));
  if (!small_cholesky(gram_)) return false;
  small_cholesky_solve(gram_, C_);
  return C_.allFinite();
}

// Takes out the rounding of C_: what is needed where multipliers are made of it.
void RowChoice::refine() {
  if (!dense() || aside_.size() > kMost) return;
  Eigen::MatrixXd change(C_.rows(), C_.cols());
  Eigen::VectorXd left(space_.variables());
  const auto add = [&](double factor, int k) {
    const Parts& of = parts_[index(k)];
    for (int i = 0; i < 2 && of.body[i] >= 0; ++i) left.segment<6>(6 * of.body[i]) += factor * of.part[i];
  };
  for (Eigen::Index d = 0; d < C_.cols(); ++d) {
    left.setZero();
    add(1, left_out_[index(d)]);
    for (Eigen::Index k = 0; k < C_.rows(); ++k) add(-C_(k, d), kept_[index(k)]);
    for (Eigen::Index k = 0; k < C_.rows(); ++k) {
      const Parts& of = parts_[index(kept_[index(k)])];
      change(k, d) = 0;
      for (int i = 0; i < 2 && of.body[i] >= 0; ++i) change(k, d) += of.part[i].dot(left.segment<6>(6 * of.body[i]));
    }
  }
  small_cholesky_solve(gram_, change);
  C_ += change;
}

bool RowChoice::find_sparse() {
  const auto part = [&](const std::vector<int>& some) {
    const Sparse& columns = space_.columns();
    Sparse of(columns.rows(), static_cast<Eigen::Index>(some.size()));
    std::vector<Eigen::Triplet<double>> entries;
    for (std::size_t c = 0; c < some.size(); ++c)
      for (Sparse::InnerIterator it(columns, some[c]); it; ++it)
        if (it.value() != 0) entries.emplace_back(static_cast<int>(it.row()), static_cast<int>(c), it.value());
    of.setFromTriplets(entries.begin(), entries.end());
    return of;
  };
  const Sparse K = part(kept_), D = part(left_out_);
  const Eigen::SimplicialLDLT<Sparse> gram(K.transpose() * K);
  if (gram.info() != Eigen::Success) return false;
  C_ = gram.solve(Eigen::MatrixXd(K.transpose() * D));
  const Eigen::MatrixXd left = Eigen::MatrixXd(D) - K * C_;
  C_ += gram.solve(K.transpose() * left);
  return C_.allFinite();
}

std::vector<SparseEntries> RowChoice::unit_null_vectors() const {
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

void RowChoice::look(double t, std::span<const BodyState> states) {
  space_.stand(t, states);
  weigh();
}

void RowChoice::weigh() {
  const bool found = find_coefficients();
  worst_ = C_.size() > 0 ? C_.cwiseAbs().maxCoeff() : 0;
  good_for_ = aside_.size() > kMost ? HUGE_VAL : turn_until_worst(found ? worst_ : kWorst, kTurnsMost);
}

bool RowChoice::renew(double t, std::span<const BodyState> states) {
  const double before = angle(worst_), turned = good_for_;
  look(t, states);
  if (!(worst_ > kWorn)) {
    const double rate = kTurnsMore * std::abs(angle(worst_) - before) / turned;
    good_for_ = std::max(good_for_, turn_until_worst(worst_, std::clamp(rate, kTurnsLittle, kTurnsMost)));
    return false;
  }
  refine();
  std::vector<int> chosen = left_out_;
  repair(unit_null_vectors(), chosen, group_);
  for (int& k : chosen) k = space_.rows()[index(k)];
  std::ranges::sort(chosen);
  if (chosen == aside_) return false;
  aside_ = std::move(chosen);
  sort_rows();
  weigh();
  refine();
  return true;
}

void RowChoice::carry_over(std::span<double> lambda) const {
  const auto at = [&](int k) -> double& { return lambda[index(space_.rows()[index(k)])]; };
  for (std::size_t d = 0; d < left_out_.size(); ++d) {
    const double force = std::exchange(at(left_out_[d]), 0.0) * space_.lengths()[index(left_out_[d])];
    for (std::size_t k = 0; k < kept_.size(); ++k)
      at(kept_[k]) +=
          C_(static_cast<Eigen::Index>(k), static_cast<Eigen::Index>(d)) * force / space_.lengths()[index(kept_[k])];
  }
}

double RowChoice::size_of(int row) const {
  const auto k = static_cast<std::size_t>(std::ranges::lower_bound(space_.rows(), row) - space_.rows().begin());
  return space_.size_of_row(k) * space_.lengths()[k];
}

std::vector<SparseEntries> RowChoice::null_vectors(double t, std::span<const BodyState> states) {
  space_.stand(t, states);
  if (!find_coefficients()) return {};
  refine();
  std::vector<SparseEntries> vectors = unit_null_vectors();
  for (SparseEntries& z : vectors)
    for (auto& [row, value] : z) {
      value /= space_.lengths()[index(row)];
      row = space_.rows()[index(row)];
    }
  return vectors;
}

}  // namespace poinsot
