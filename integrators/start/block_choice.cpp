#include "integrators/start/block_choice.h"

#include <Eigen/SparseCholesky>
#include <algorithm>
#include <cmath>
#include <numeric>
#include <random>
#include <utility>

#include "core/index.h"
#include "integrators/start/small_cholesky.h"
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
constexpr double kNothing = 1e-12;    // of a coefficient beside the row set aside
constexpr Eigen::Index kDense = 120;  // rows up to which full matrices are faster
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
    : rows_(std::move(rows)) {
  std::vector<int> left_out;
  for (std::size_t k = 0; k < rows_.size(); ++k) {
    const int row = space.rows()[index(rows_[k])];
    group_.push_back(model.rows[index(row)].group);
    if (std::ranges::binary_search(aside, row)) left_out.push_back(static_cast<int>(k));
  }
  find_bodies(space);
  keep_others(left_out);
  find_beside(model, space);
}

void BlockChoice::find_bodies(const RowSpace& space) {
  std::vector<int> of_rows;
  for (const int row : rows_) {
    int last = -1;
    for (Sparse::InnerIterator it(space.columns(), row); it; ++it)
      if (const int body = static_cast<int>(it.row()) / 6; body != last) of_rows.push_back(last = body);
  }
  std::ranges::sort(of_rows);
  double products = 0;  // of rows that share a body
  for (auto first = of_rows.begin(); first != of_rows.end();) {
    const auto last = std::ranges::upper_bound(first, of_rows.end(), *first);
    products += std::pow(last - first, 2);
    bodies_.push_back(*first);
    first = last;
  }
  watched_ = products <= kMostProducts;
}

void BlockChoice::find_beside(const Model& model, const RowSpace& space) {
  if (!dense()) return;
  const std::size_t n = rows_.size();
  beside_.resize(n);
  const auto row = [&](std::size_t k) -> const Row& { return model.rows[index(space.rows()[index(rows_[k])])]; };
  const auto share = [](const Row& a, const Row& b) {
    const auto acts_on = [&](int body) { return body != kGround && (body == b.i || body == b.j); };
    return acts_on(a.i) || acts_on(a.j);
  };
  for (std::size_t k = 0; k < n; ++k)
    for (std::size_t l = 0; l < n; ++l)
      if (share(row(k), row(l))) beside_[k].push_back(static_cast<int>(l));
}

void BlockChoice::keep_others(const std::vector<int>& left_out) {
  left_out_ = left_out;
  kept_.clear();
  for (int k = 0; k < static_cast<int>(rows_.size()); ++k)
    if (!std::ranges::binary_search(left_out_, k)) kept_.push_back(k);
}

bool BlockChoice::large() const {
  return left_out_.size() > kMost || left_out_.size() * kept_.size() > kMostCoefficients;
}

bool BlockChoice::dense() const {
  return static_cast<Eigen::Index>(kept_.size()) <= kDense;
}

bool BlockChoice::find_coefficients(const RowSpace& space) {
  if (dense() ? find_dense(space) : find_sparse(space)) return true;
  C_.setZero(static_cast<Eigen::Index>(kept_.size()), static_cast<Eigen::Index>(left_out_.size()));
  return false;
}

int BlockChoice::place_of_body(int body) const {
  return static_cast<int>(std::ranges::lower_bound(bodies_, body) - bodies_.begin());
}

// Unit vectors of some rows, on the bodies of the block.
Sparse BlockChoice::columns(const RowSpace& space, const std::vector<int>& some) const {
  Sparse of(6 * static_cast<Eigen::Index>(bodies_.size()), static_cast<Eigen::Index>(some.size()));
  of.reserve(12 * static_cast<Eigen::Index>(some.size()));
  for (std::size_t c = 0; c < some.size(); ++c) {
    const auto column = static_cast<Eigen::Index>(c);
    of.startVec(column);
    for (Sparse::InnerIterator it(space.columns(), rows_[index(some[c])]); it; ++it)
      if (it.value() != 0)
        of.insertBack(6 * place_of_body(static_cast<int>(it.row()) / 6) + it.row() % 6, column) = it.value();
  }
  of.finalize();
  return of;
}

// The parts of a unit row on its bodies.
void BlockChoice::take_parts(const RowSpace& space) {
  parts_.resize(rows_.size());
  for (std::size_t k = 0; k < parts_.size(); ++k) {
    Parts& of = parts_[k];
    of.body[0] = of.body[1] = -1;
    int at = -1, last = -1;
    for (Sparse::InnerIterator it(space.columns(), rows_[k]); it; ++it) {
      const int body = static_cast<int>(it.row()) / 6;
      if (body != last) {
        of.body[++at] = place_of_body(body);
        of.part[at].setZero();
        last = body;
      }
      of.part[at][it.row() % 6] = it.value();
    }
  }
}

double BlockChoice::dot(int k, int l) const {
  const Parts &a = parts_[index(k)], &b = parts_[index(l)];
  double sum = 0;
  for (int i = 0; i < 2 && a.body[i] >= 0; ++i)
    for (int j = 0; j < 2; ++j)
      if (a.body[i] == b.body[j]) sum += a.part[i].dot(b.part[j]);
  return sum;
}

bool BlockChoice::find_dense(const RowSpace& space) {
  const auto n = static_cast<Eigen::Index>(kept_.size()), m = static_cast<Eigen::Index>(left_out_.size());
  take_parts(space);
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
void BlockChoice::refine() {
  if (!dense()) return;
  Eigen::MatrixXd change(C_.rows(), C_.cols());
  Eigen::VectorXd left(6 * static_cast<Eigen::Index>(bodies_.size()));
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

bool BlockChoice::find_sparse(const RowSpace& space) {
  const Sparse K = columns(space, kept_), D = columns(space, left_out_);
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
  bool found = true;
  if (large()) {
    worst_ = estimate(space, left_out_);
  } else {
    found = find_coefficients(space);
    worst_ = C_.cwiseAbs().maxCoeff();
  }
  good_for_ = turn_until_worst(found ? worst_ : kWorst, kTurnsMost);
}

bool BlockChoice::worn() const {
  return worst_ > kWorn;
}

bool BlockChoice::renew(const RowSpace& space, double turned) {
  if (!watched_) return false;
  const double before = angle(worst_);
  const bool sums = !dense() && !large();
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
  return large() ? choose_clearest(space) : exchange(space);
}

bool BlockChoice::exchange(const RowSpace& space) {
  refine();
  std::vector<int> chosen = left_out_;
  repair(unit_null_vectors(), chosen, group_);
  std::ranges::sort(chosen);
  if (chosen == left_out_) return false;
  keep_others(chosen);
  look(space);
  refine();
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
  std::vector<int> kept;
  for (int k = 0; k < static_cast<int>(rows_.size()); ++k)
    if (!std::ranges::binary_search(left_out, k)) kept.push_back(k);
  const Sparse K = columns(space, kept), D = columns(space, left_out);
  const Eigen::SimplicialLDLT<Sparse> gram(K.transpose() * K);
  if (gram.info() != Eigen::Success) return HUGE_VAL;
  std::mt19937 random(1);
  const Eigen::MatrixXd signs =
      Eigen::MatrixXd::NullaryExpr(D.cols(), kVectors, [&] { return random() % 2 == 0 ? 1.0 : -1.0; });
  const Eigen::MatrixXd sums = gram.solve(K.transpose() * (D * signs));
  return sums.allFinite() ? std::sqrt(sums.rowwise().squaredNorm().maxCoeff() / kVectors) / 2 : HUGE_VAL;
}

std::vector<int> BlockChoice::clearest(const RowSpace& space) const {
  std::vector<int> all(rows_.size());
  std::iota(all.begin(), all.end(), 0);
  return clearest_dependent_columns(columns(space, all), kIndependent);
}

void BlockChoice::add_aside(const RowSpace& space, std::vector<int>& rows) const {
  for (const int k : left_out_) rows.push_back(space.rows()[index(rows_[index(k)])]);
}

void BlockChoice::carry_over(const RowSpace& space, std::span<double> lambda) const {
  const auto at = [&](int k) -> double& { return lambda[index(space.rows()[index(rows_[index(k)])])]; };
  const auto length = [&](int k) { return space.lengths()[index(rows_[index(k)])]; };
  Eigen::VectorXd forces(static_cast<Eigen::Index>(left_out_.size()));
  for (std::size_t d = 0; d < left_out_.size(); ++d)
    forces[static_cast<Eigen::Index>(d)] = std::exchange(at(left_out_[d]), 0.0) * length(left_out_[d]);
  Eigen::VectorXd shares;  // of the kept rows
  if (large()) {
    const Sparse K = columns(space, kept_);
    const Eigen::VectorXd all = columns(space, left_out_) * forces;
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
  refine();
  for (SparseEntries& z : unit_null_vectors()) {
    for (auto& [k, value] : z) {
      const int row = rows_[index(k)];
      value /= space.lengths()[index(row)];
      k = space.rows()[index(row)];
    }
    vectors.push_back(std::move(z));
  }
}

}  // namespace poinsot
