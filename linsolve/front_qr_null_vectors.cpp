// What R is for: null vectors by back substitution, sums over all of them, the normal equations.
#include <algorithm>
#include <cmath>
#include <queue>
#include <utility>

#include "core/check.h"
#include "core/index.h"
#include "linsolve/few_rows.h"
#include "linsolve/front_qr.h"

namespace poinsot {
namespace {

constexpr double kNoPart = 1e-13;  // of a coefficient

}  // namespace

void FrontQr::store_by_column() {
  start_.assign(place_.size() + 1, 0);
  for (const Entry& entry : R_) ++start_[index(entry.place) + 1];
  for (std::size_t k = 0; k + 1 < start_.size(); ++k) start_[k + 1] += start_[k];
  std::vector<std::size_t> next = start_;
  std::vector<Entry> sorted(R_.size());
  for (const Entry& entry : R_) sorted[next[index(entry.place)]++] = entry;
  R_ = std::move(sorted);
}

// Back substitution with the rows that are reached only.
SparseEntries FrontQr::null_vector(int column) {
  check(has_R_, "null vectors of no more columns than was said");
  if (start_.empty()) store_by_column();
  std::priority_queue<int> reached;
  std::vector<double>& b = work_;
  b.resize(place_.size());
  const auto subtract = [&](int place, double x, bool whole) {
    const std::size_t end = start_[index(place) + 1] - (whole ? 0 : 1);
    for (std::size_t k = start_[index(place)]; k < end; ++k) {
      if (b[index(R_[k].row)] == 0) reached.push(R_[k].row);
      b[index(R_[k].row)] -= R_[k].value * x;
    }
  };
  SparseEntries z = {{column, 1.0}};
  subtract(place_[index(column)], 1, true);
  while (!reached.empty()) {
    const int place = reached.top();
    reached.pop();
    const double rest = std::exchange(b[index(place)], 0.0);
    if (std::abs(rest) <= kNoPart) continue;  // also where it was reached twice
    const double x = rest / R_[start_[index(place) + 1] - 1].value;
    z.emplace_back(column_[index(place)], x);
    subtract(place, x, false);
  }
  std::sort(z.begin(), z.end());
  return z;
}

FrontQr::Sums FrontQr::times_null_vectors(const Eigen::MatrixXd& b) {
  check(has_R_, "null vectors of no more columns than was said");
  if (start_.empty()) store_by_column();
  Eigen::MatrixXd y(b.rows(), b.cols());  // of dependent columns, of which R has no row, the sums
  Eigen::VectorXd sizes(b.cols()), size(b.rows());
  for (Eigen::Index place = 0; place < y.cols(); ++place) {
    auto sum = y.col(place);
    sum = b.col(column_[index(place)]);
    size = sum.cwiseAbs();
    for (std::size_t k = start_[index(place)]; k < start_[index(place + 1)]; ++k) {
      if (R_[k].row == place) {
        sum /= R_[k].value;
        break;
      }
      const auto row = y.col(R_[k].row);
      sum -= R_[k].value * row;
      size += std::abs(R_[k].value) * row.cwiseAbs();
    }
    sizes[place] = size.maxCoeff();
  }
  const auto count = static_cast<Eigen::Index>(dependent_.size());
  Sums sums{Eigen::MatrixXd(b.rows(), count), Eigen::VectorXd(count)};
  for (Eigen::Index k = 0; k < count; ++k) {
    const int place = place_[index(dependent_[index(k)])];
    sums.values.col(k) = y.col(place);
    sums.sizes[k] = sizes[place];
  }
  return sums;
}

void FrontQr::solve_normal_equations(Eigen::MatrixXd& b) {
  check(has_R_, "R of a decomposition that keeps it");
  if (start_.empty()) store_by_column();
  with_count(b.rows(), [&]<int Count>(std::integral_constant<int, Count>) { solve_normal_equations_of<Count>(b); });
}

template <int Count>
void FrontQr::solve_normal_equations_of(Eigen::MatrixXd& b) const {
  using Rows = Eigen::Matrix<double, Count, Eigen::Dynamic>;
  const auto last = [&](Eigen::Index place) { return start_[index(place + 1)] - 1; };
  // Of a dependent column R has no diagonal, and no row.
  const auto independent = [&](Eigen::Index place) {
    return start_[index(place)] < start_[index(place + 1)] && R_[last(place)].row == place;
  };
  Rows y = Rows::Zero(b.rows(), b.cols());
  for (Eigen::Index place = 0; place < y.cols(); ++place) {
    if (!independent(place)) continue;
    typename Rows::ColXpr::PlainObject sum = b.col(column_[index(place)]);
    for (std::size_t k = start_[index(place)]; k < last(place); ++k) sum -= R_[k].value * y.col(R_[k].row);
    y.col(place) = sum / R_[last(place)].value;
  }
  for (Eigen::Index place = y.cols(); place-- > 0;) {
    if (independent(place)) {
      const typename Rows::ColXpr::PlainObject x = y.col(place) / R_[last(place)].value;
      y.col(place) = x;
      for (std::size_t k = start_[index(place)]; k < last(place); ++k) y.col(R_[k].row) -= R_[k].value * x;
    }
    b.col(column_[index(place)]) = y.col(place);
  }
}

}  // namespace poinsot
