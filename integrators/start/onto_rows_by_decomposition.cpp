#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <utility>

#include "core/index.h"
#include "integrators/start/onto_rows.h"
#include "integrators/stepping/vectors.h"
#include "linsolve/few_rows.h"

namespace poinsot {
namespace {

constexpr int kNewtonSteps = 8;
constexpr double kShrinks = 0.1;          // corrections, each time: the decomposition leads on
constexpr double kOfCoordinates = 1e-14;  // relative to the largest coordinate: rounding
constexpr double kLeftOut = 1e-13;        // entries of a column of unit length
constexpr double kFewLeft = 1e-11;        // of a move: far less than is looked for in it
constexpr double kMuch = 10;              // times a move
constexpr double kNearRounding = 1e-9;    // likewise: where corrections may stop to shrink

// A correction after one that followed `before`, if they go on to shrink as they did.
double next(double correction, double before) {
  return std::isinf(before) ? correction : correction * (correction / before);
}

class ByDecomposition : public OntoRows {
 public:
  ByDecomposition(std::shared_ptr<FrontQr> decomposition, RowSpace& space, std::span<const double> sizes)
      : OntoRows(space, rows_of(decomposition->dependent(), space), sizes),
        decomposition_(std::move(decomposition)),
        off_(space.rows().size()),
        nu_(off_) {}

  bool position(double t, std::span<double> q) override {
    const double scale = std::max(1.0, largest(q));
    std::vector<double> moved(q.size()), dq(index(space_.columns().rows()));
    double before = HUGE_VAL;
    for (int k = 0; k < kNewtonSteps; ++k) {
      space_.move(t, q);
      space_.distances(off_);
      for (std::size_t row = 0; row < off_.size(); ++row) off_[row] *= space_.norm_of_row(row) / space_.lengths()[row];
      least_move(dq);
      const double correction = largest(dq);
      const bool shrinks = correction < kShrinks * before;
      if (!shrinks && !(correction <= kNearRounding * scale)) return false;
      space_.problem().retract(q, dq, moved);
      std::ranges::copy(moved, q.begin());
      if (!shrinks || next(correction, before) <= kOfCoordinates * scale) return true;
      before = correction;
    }
    return false;
  }

  bool velocity(double t, std::span<const double> q, std::span<double> v) override {
    std::vector<double> dv(v.size());
    space_.move(t, q);
    for (int k = 0; k < 2; ++k) {  // the second pass takes out the rounding of large corrections
      space_.rates(v, off_, nu_);
      for (std::size_t row = 0; row < off_.size(); ++row)
        if (off_[row] != 0) off_[row] /= space_.lengths()[row];
      least_move(dv);
      for (std::size_t j = 0; j < v.size(); ++j) v[j] += dv[j];
    }
    return std::ranges::all_of(v, [](double x) { return std::isfinite(x); });
  }

  bool leave_free(double, Eigen::MatrixXd& moves) override {
    const Eigen::RowVectorXd scales = Eigen::RowVectorXd::NullaryExpr(moves.cols(), [&](auto j) { return scaled(j); });
    moves = moves * scales.asDiagonal();
    const double asked = moves.lpNorm<Eigen::Infinity>();
    double before = HUGE_VAL;
    for (int k = 0; k < kNewtonSteps; ++k) {
      Eigen::MatrixXd y = times(moves, space_.columns());
      decomposition_->solve_normal_equations(y);
      const Eigen::MatrixXd held = times_transposed(y, space_.columns());
      moves -= held;
      const double correction = held.lpNorm<Eigen::Infinity>();
      const double most = k == 0 ? kMuch * asked : kShrinks * before;  // or the decomposition does not lead there
      if (!(correction < most) || next(correction, before) <= kFewLeft * asked) break;
      before = correction;
    }
    moves = moves * scales.cwiseInverse().asDiagonal();
    return moves.allFinite();
  }

 private:
  // By a decomposition of the same columns there. What it leaves out costs a pass, and saves the fill that rounding
  // makes of a mechanism that stays in a plane.
  bool be_exact(double) override {
    Eigen::SparseMatrix<double> kept = space_.columns();
    for (const int row : without_) {
      const auto column = std::ranges::lower_bound(space_.rows(), row) - space_.rows().begin();
      for (Eigen::SparseMatrix<double>::InnerIterator it(kept, column); it; ++it) it.valueRef() = 0;
    }
    kept.prune([](Eigen::Index, Eigen::Index, double value) { return std::abs(value) > kLeftOut; });
    decomposition_ = std::make_shared<FrontQr>(kept, std::vector<char>(index(kept.rows()), 0), kDependent,
                                               FrontQr::Choice::by_order, SIZE_MAX);
    return decomposition_->dependent().size() == without_.size();
  }

  static std::vector<int> rows_of(std::vector<int> columns, const RowSpace& space) {
    for (int& column : columns) column = space.rows()[index(column)];
    std::ranges::sort(columns);
    return columns;
  }

  // The shortest for rows that are off by `off_`, by the space's lengths.
  void least_move(std::span<double> move) {
    Eigen::MatrixXd y = Eigen::RowVectorXd::Map(off_.data(), static_cast<Eigen::Index>(off_.size()));
    decomposition_->solve_normal_equations(y);
    const Eigen::MatrixXd x = times_transposed(y, space_.columns());
    for (Eigen::Index j = 0; j < x.size(); ++j) move[index(j)] = -x(0, j) / scaled(j);
  }

  std::shared_ptr<FrontQr> decomposition_;
  std::vector<double> off_, nu_;
};

}  // namespace

std::unique_ptr<OntoRows> onto_rows_by_decomposition(std::shared_ptr<FrontQr> decomposition, RowSpace& space,
                                                     std::span<const double> sizes) {
  return std::make_unique<ByDecomposition>(std::move(decomposition), space, sizes);
}

}  // namespace poinsot
