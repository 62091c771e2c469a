#include "integrators/start/small_coefficients.h"

#include <algorithm>
#include <cmath>
#include <type_traits>

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

// Entries j to j + kLanes − 1 of a row x of L, as those before stand; j is a multiple of kLanes, `y` row j of L. One
// after the other would load x as often.
void entries_together(double* x, const double* y, int stride, const double* inverse, int from, int j) {
  Vec sum[kLanes] = {};
  for (int k = from / kLanes * kLanes; k < j; k += kLanes)
    unrolled<kLanes>([&, at = load(x + k)](auto r) { sum[r] += at * load(y + r * stride + k); });
  unrolled<kLanes>([&](auto r) {
    double value = x[j + r];
    for (int lane = 0; lane < kLanes; ++lane) value -= sum[r][lane];
    for (int s = 0; s < r; ++s) value -= y[r * stride + j + s] * x[j + s];
    x[j + r] = value * inverse[j + r];
  });
}

}  // namespace

void SmallCoefficients::arrange(const BlockRows& rows, const std::vector<int>& kept, const std::vector<int>& left_out) {
  kept_ = static_cast<int>(kept.size());
  const int n = kept_, m = static_cast<int>(left_out.size());
  std::vector<int> place(rows.size());
  first_.resize(rows.size());
  for (int j = 0; j < n; ++j) place[index(kept[index(j)])] = first_[index(j)] = j;
  for (int d = 0; d < m; ++d) place[index(left_out[index(d)])] = n + d, first_[index(n + d)] = n;
  stride_ = padded(n);
  const int diagonal = (n + m) * stride_, nowhere = diagonal + n;
  L_.assign(index(nowhere + 1), 0);
  x_.assign(index(kTogether * stride_), 0);
  at_.clear();
  rows.for_each_pair([&](int k, int l) {
    const auto [j, i] = std::minmax(place[index(k)], place[index(l)]);
    if (j < n) first_[index(i)] = std::min(first_[index(i)], j);
    at_.push_back(j >= n ? nowhere : i == j ? diagonal + j : i * stride_ + j);
  });
}

bool SmallCoefficients::find(const BlockRows& rows, Eigen::MatrixXd& C) {
  L_.assign(L_.size(), 0);
  const int* at = at_.data();
  rows.for_each_product([&](double product) { L_[index(*at++)] += product; });
  if (!decompose()) return false;
  const int left_out = static_cast<int>(first_.size()) - kept_;
  C.resize(kept_, left_out);
  const auto columns = [&](auto count, int first) {
    for (int d = 0; d < count; ++d) std::copy_n(row(kept_ + first + d), kept_, x_.begin() + d * stride_);
    backward<count>();
    for (int d = 0; d < count; ++d) std::copy_n(x_.begin() + d * stride_, kept_, C.col(first + d).begin());
  };
  int d = 0;
  for (; d + kTogether <= left_out; d += kTogether) columns(std::integral_constant<int, kTogether>(), d);
  for (; d < left_out; ++d) columns(std::integral_constant<int, 1>(), d);
  return C.allFinite();
}

// Row by row: the entries of G_K G_Kᵀ and, below, of G_K g_d stand where those of L are to be.
bool SmallCoefficients::decompose() {
  double* inverse = inverses();
  least_pivot_ = HUGE_VAL;
  for (int i = 0; i < static_cast<int>(first_.size()); ++i) {
    double* x = row(i);
    const int first = first_[index(i)], end = std::min(i, kept_);
    const auto entry = [&](int j) {
      x[j] = (x[j] - dot_within(x, row(j), std::max(first, first_[index(j)]), j)) * inverse[j];
    };
    int j = first;
    for (; j < end && j % kLanes != 0; ++j) entry(j);
    for (; j + kLanes <= end; j += kLanes) {
      const int earliest = *std::min_element(&first_[index(j)], &first_[index(j)] + kLanes);
      entries_together(x, row(j), stride_, inverse, std::max(first, earliest), j);
    }
    for (; j < end; ++j) entry(j);
    if (i >= kept_) continue;
    double& pivot = inverse[i];
    pivot -= dot_within(x, x, first_[index(i)], i);
    if (!(pivot > 0)) return false;
    least_pivot_ = std::min(least_pivot_, pivot);
    pivot = 1 / std::sqrt(pivot);
  }
  return true;
}

// x ← L⁻¹ x, and x ← L⁻ᵀ x of several x, a row of L being loaded once.
void SmallCoefficients::forward() {
  for (int j = 0; j < kept_; ++j)
    x_[index(j)] = (x_[index(j)] - dot_within(row(j), x_.data(), first_[index(j)], j)) * inverses()[j];
}
template <int Columns>
void SmallCoefficients::backward() {
  double* x = x_.data();
  for (int j = kept_; j-- > 0;) {
    double by[Columns];
    for (int c = 0; c < Columns; ++c) by[c] = x[c * stride_ + j] *= inverses()[j];
    for (int k = first_[index(j)] / kLanes * kLanes; k < j; k += kLanes) {
      const Vec l = load(row(j) + k);
      for (int c = 0; c < Columns; ++c) store(x + c * stride_ + k, load(x + c * stride_ + k) - l * by[c]);
    }
  }
}

void SmallCoefficients::refine(const BlockRows& rows, const std::vector<int>& kept, const Eigen::VectorXd& f,
                               Eigen::Ref<Eigen::VectorXd> c) {
  left_ = f;
  for (Eigen::Index k = 0; k < c.size(); ++k) rows.add(-c[k], kept[index(k)], left_);
  for (Eigen::Index k = 0; k < c.size(); ++k) x_[index(k)] = rows.share(kept[index(k)], left_);
  forward();
  backward<1>();
  for (Eigen::Index k = 0; k < c.size(); ++k) c[k] += x_[index(k)];
}

}  // namespace poinsot
