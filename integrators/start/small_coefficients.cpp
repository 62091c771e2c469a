#include "integrators/start/small_coefficients.h"

#include <algorithm>
#include <cmath>

#include "core/index.h"
#include "linsolve/lanes.h"

namespace poinsot {
namespace {

// Entries from `from` to `to` in whole vectors: what these have beyond is zero in x or in y.
double dot_within(const double* x, const double* y, int from, int to) {
  Vec sum = {};
  for (int k = from / kLanes * kLanes; k < to; k += kLanes) sum += load(x + k) * load(y + k);
  double all = 0;
  for (int lane = 0; lane < kLanes; ++lane) all += sum[lane];
  return all;
}

}  // namespace

bool SmallCoefficients::find(const BlockRows& rows, const std::vector<int>& kept, const std::vector<int>& left_out,
                             Eigen::MatrixXd& C) {
  const int n = static_cast<int>(kept.size()), m = static_cast<int>(left_out.size());
  place_.resize(rows.size());
  first_.resize(rows.size());
  for (int j = 0; j < n; ++j) place_[index(kept[index(j)])] = first_[index(j)] = j;
  for (int d = 0; d < m; ++d) place_[index(left_out[index(d)])] = n + d, first_[index(n + d)] = n;
  stride_ = padded(n);
  L_.assign(index((n + m) * stride_), 0);
  inverse_.assign(index(n), 0);
  x_.assign(index(stride_), 0);
  rows.for_each_product([&](int k, int l, double product) {
    const auto [j, i] = std::minmax(place_[index(k)], place_[index(l)]);
    if (j >= n) return;
    first_[index(i)] = std::min(first_[index(i)], j);
    (i == j ? inverse_[index(j)] : row(i)[j]) += product;
  });
  if (!decompose(n)) return false;
  C.resize(n, m);
  for (int d = 0; d < m; ++d) {
    std::copy_n(row(n + d), n, x_.begin());
    backward(x_);
    std::copy_n(x_.begin(), n, C.col(d).begin());
  }
  return C.allFinite();
}

// Row by row: the entries of G_K G_Kᵀ and, below, of G_K g_d stand where those of L are to be.
bool SmallCoefficients::decompose(int kept) {
  for (int i = 0; i < static_cast<int>(place_.size()); ++i) {
    double* x = row(i);
    for (int j = first_[index(i)]; j < std::min(i, kept); ++j)
      x[j] = (x[j] - dot_within(x, row(j), std::max(first_[index(i)], first_[index(j)]), j)) * inverse_[index(j)];
    if (i >= kept) continue;
    double& pivot = inverse_[index(i)];
    pivot -= dot_within(x, x, first_[index(i)], i);
    if (!(pivot > 0)) return false;
    pivot = 1 / std::sqrt(pivot);
  }
  return true;
}

// x ← L⁻¹ x and x ← L⁻ᵀ x
void SmallCoefficients::forward(std::span<double> x) const {
  for (int j = 0; j < static_cast<int>(inverse_.size()); ++j)
    x[index(j)] = (x[index(j)] - dot_within(row(j), x.data(), first_[index(j)], j)) * inverse_[index(j)];
}
void SmallCoefficients::backward(std::span<double> x) const {
  for (int j = static_cast<int>(inverse_.size()); j-- > 0;) {
    const double by = x[index(j)] *= inverse_[index(j)];
    for (int k = first_[index(j)] / kLanes * kLanes; k < j; k += kLanes)
      store(x.data() + k, load(x.data() + k) - load(row(j) + k) * by);
  }
}

void SmallCoefficients::refine(const BlockRows& rows, const std::vector<int>& kept, const std::vector<int>& left_out,
                               Eigen::MatrixXd& C) {
  Eigen::VectorXd left(rows.variables());
  for (Eigen::Index d = 0; d < C.cols(); ++d) {
    left.setZero();
    rows.add(1, left_out[index(d)], left);
    for (Eigen::Index k = 0; k < C.rows(); ++k) rows.add(-C(k, d), kept[index(k)], left);
    for (Eigen::Index k = 0; k < C.rows(); ++k) x_[index(k)] = rows.share(kept[index(k)], left);
    forward(x_);
    backward(x_);
    for (Eigen::Index k = 0; k < C.rows(); ++k) C(k, d) += x_[index(k)];
  }
}

}  // namespace poinsot
