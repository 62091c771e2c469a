// Dense operations on one front (linsolve/block_schedule.h), for a number of pivots P fixed at compile time.
//
//   eliminate:  P_r D = L_D U_D with partial pivoting inside the block,  U ← P_r U,  L ← L (L_D U_D)⁻¹,  W ← W − L U
//   forward:    b₁ ← P_r b₁,  b₂ ← b₂ − L b₁
//   backward:   b₁ ← (L_D U_D)⁻¹ (b₁ − U b₂)
//
// The diagonal of U_D is stored inverted. P = 0 stands for a number known at run time only. Rows go by whole vectors:
// the padding rows of L and W are zero and stay so.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <utility>

#include "linsolve/block_schedule.h"

namespace poinsot::block {

// A vector of the machine, by the compilers' common extension; plain arithmetic on it.
typedef double Vec __attribute__((vector_size(kLanes * sizeof(double))));
inline Vec load(const double* x) {
  Vec v;
  std::memcpy(&v, x, sizeof v);
  return v;
}
inline void store(double* x, Vec v) {
  std::memcpy(x, &v, sizeof v);
}

// Two numbers at a time, for short runs.
inline constexpr int kPair = 2;
typedef double Pair __attribute__((vector_size(kPair * sizeof(double))));
inline Pair load_pair(const double* x) {
  Pair v;
  std::memcpy(&v, x, sizeof v);
  return v;
}
inline void store_pair(double* x, Pair v) {
  std::memcpy(x, &v, sizeof v);
}

// Rows are exchanged where a candidate is this much larger than the diagonal. M below G, in the column of a body with
// small inertia, is no reason to: pivots on M are those of the definite Schur complement.
inline constexpr double kReluctance = 1e3;

// How far pivots are from those of a factorization that was examined: the least and the largest |u| / |u then|.
struct Drift {
  double least = 1, largest = 1, poison = 0;  // poison is 0 while all pivots are numbers

  void add(double ratio) {
    least = std::min(least, ratio);
    largest = std::max(largest, ratio);
    poison += ratio * 0;
  }
};

// Calls f(std::integral_constant<int, k>()) for k = 0 … N − 1, each written out.
template <int N, class F>
inline void unrolled(F&& f) {
  [&]<int... k>(std::integer_sequence<int, k...>) {
    (f(std::integral_constant<int, k>()), ...);
  }
  (std::make_integer_sequence<int, N>());
}

// As factor_pivots, for the common case that the diagonal serves: straight-line code. False, and D as it was, where a
// row has to be exchanged.
template <int P>
inline bool factor_diagonal(double* D, const double* weight, const double* then, Drift& drift) {
  double a[P * P];
  std::copy_n(D, P * P, a);
  double excess = 0;
  Drift seen = drift;
  unrolled<P>([&](auto k) {
    double largest = 0;
    unrolled<P>([&](auto i) {
      if constexpr (i > k) largest = std::max(largest, std::abs(a[k * P + i]) * weight[i]);
    });
    excess = std::max(excess, largest - kReluctance * std::abs(a[k * P + k]) * weight[k]);
    seen.add(std::abs(a[k * P + k]) * then[k]);
    const double inverse = 1 / a[k * P + k];
    a[k * P + k] = inverse;
    unrolled<P>([&](auto i) {
      if constexpr (i > k) a[k * P + i] *= inverse;
    });
    unrolled<P>([&](auto j) {
      if constexpr (j > k)
        unrolled<P>([&](auto i) {
          if constexpr (i > k) a[j * P + i] -= a[k * P + i] * a[j * P + k];
        });
    });
  });
  if (!(excess <= 0)) return false;
  drift = seen;
  std::copy_n(a, P * P, D);
  return true;
}

// D ← its factors, p × p. Candidates are compared in units of their rows, given by `weight` (permuted along). The
// diagonal is preferred: an order of rows that stays the same keeps the
// pivots comparable. True where rows were exchanged. `then` holds 1/|pivot| for Drift.
template <int P>
inline bool factor_pivots(double* D, int p_run, std::uint16_t* order, double* weight, const double* then,
                          Drift& drift) {
  const int p = P ? P : p_run;
  bool exchanged = false;
  for (int k = 0; k < p; ++k) {
    double* column = D + k * p;
    int best = k;
    const double diagonal = kReluctance * std::abs(column[k]) * weight[k];
    double largest = 0;
    for (int i = k + 1; i < p; ++i) largest = std::max(largest, std::abs(column[i]) * weight[i]);
    if (largest > diagonal) {
      while (std::abs(column[best]) * weight[best] != largest) ++best;
      for (int j = 0; j < p; ++j) std::swap(D[j * p + k], D[j * p + best]);
      std::swap(weight[k], weight[best]);
      exchanged = true;
    }
    order[k] = static_cast<std::uint16_t>(best);
    drift.add(std::abs(column[k]) * then[k]);
    const double inverse = 1 / column[k];
    column[k] = inverse;
    for (int i = k + 1; i < p; ++i) column[i] *= inverse;
    for (int j = k + 1; j < p; ++j) {
      const double u = D[j * p + k];
      for (int i = k + 1; i < p; ++i) D[j * p + i] -= column[i] * u;
    }
  }
  return exchanged;
}

template <int P>
inline void exchange(const std::uint16_t* order, int p_run, double* x) {
  const int p = P ? P : p_run;
  for (int k = 0; k < p; ++k)
    if (order[k] != k) std::swap(x[k], x[order[k]]);
}

// L ← L (L_D U_D)⁻¹ for C vectors of rows from `row` on, kept in registers, and with them `out` ← W − L U.
template <int P, int C>
inline void eliminate_rows(const double* D, double* L, const double* U, const double* W, double* out, int m, int rows,
                           int row) {
  Vec x[P][C];
  L += row, W += row, out += row;
  unrolled<P>([&](auto k) {
    unrolled<C>([&](auto c) { x[k][c] = load(L + k * rows + c * kLanes); });
    unrolled<P>([&](auto j) {
      if constexpr (j < k) unrolled<C>([&](auto c) { x[k][c] -= x[j][c] * D[k * P + j]; });
    });
    unrolled<C>([&](auto c) { x[k][c] *= D[k * P + k]; });
  });
  unrolled<P>([&](auto back) {
    constexpr int k = P - 1 - back;
    unrolled<P>([&](auto j) {
      if constexpr (j > k) unrolled<C>([&](auto c) { x[k][c] -= x[j][c] * D[k * P + j]; });
    });
    unrolled<C>([&](auto c) { store(L + k * rows + c * kLanes, x[k][c]); });
  });
  for (int j = 0; j < m; ++j, W += rows, out += rows, U += P) {
    Vec w[C];
    unrolled<C>([&](auto c) { w[c] = load(W + c * kLanes); });
    unrolled<P>([&](auto k) { unrolled<C>([&](auto c) { w[c] -= x[k][c] * U[k]; }); });
    unrolled<C>([&](auto c) { store(out + c * kLanes, w[c]); });
  }
}

// True where rows were exchanged; then `order` says how.
template <int P>
bool eliminate(double* D, const Front& f, const double* W, double* out, std::uint16_t* order, double* weight,
               const double* then, Drift& drift) {
  const int p = P ? P : f.pivots, m = f.others, rows = f.rows;
  double *L = D + p * p, *U = L + p * rows;
  bool exchanged = true;
  if constexpr (P > 0) exchanged = !factor_diagonal<P>(D, weight, then, drift);
  if (exchanged) exchanged = factor_pivots<P>(D, p, order, weight, then, drift);
  if (exchanged)
    for (int j = 0; j < m; ++j) exchange<P>(order, p, U + j * p);
  if constexpr (P > 0) {
    // As many rows at once as leave room in the registers.
    constexpr int kTogether = P <= 6 ? 2 : 1;
    int row = 0;
    for (; row + kTogether * kLanes <= rows; row += kTogether * kLanes)
      eliminate_rows<P, kTogether>(D, L, U, W, out, m, rows, row);
    if constexpr (kTogether > 1)
      if (row < rows) eliminate_rows<P, 1>(D, L, U, W, out, m, rows, row);
  } else {
    for (int k = 0; k < p; ++k) {
      double* x = L + k * rows;
      for (int j = 0; j < k; ++j) {
        const double u = D[k * p + j];
        const double* y = L + j * rows;
        for (int i = 0; i < rows; ++i) x[i] -= y[i] * u;
      }
      for (int i = 0; i < rows; ++i) x[i] *= D[k * p + k];
    }
    for (int k = p - 1; k >= 0; --k)
      for (int j = k + 1; j < p; ++j) {
        const double l = D[k * p + j];
        double* x = L + k * rows;
        const double* y = L + j * rows;
        for (int i = 0; i < rows; ++i) x[i] -= y[i] * l;
      }
    std::copy_n(W, m * rows, out);
    for (int j = 0; j < m; ++j)
      for (int k = 0; k < p; ++k) {
        const double u = U[j * p + k];
        const double* y = L + k * rows;
        for (int i = 0; i < rows; ++i) out[j * rows + i] -= y[i] * u;
      }
  }
  return exchanged;
}

// x: the permuted right-hand side; t: room for `rows` numbers; `order` is null where no rows were exchanged.
template <int P>
inline void forward(const double* D, const Front& f, const int* position, const std::uint16_t* order, double* x,
                    double* t) {
  const int p = P ? P : f.pivots, m = f.others, rows = f.rows;
  double* b = x + f.first;
  if (order) exchange<P>(order, p, b);
  const double* L = D + p * p;
  if constexpr (P > 0) {
    double own[P];
    std::copy_n(b, P, own);
    for (int row = 0; row < rows; row += kLanes) {
      Vec sum = load(L + row) * own[0];
      unrolled<P>([&](auto k) {
        if constexpr (k > 0) sum += load(L + k * rows + row) * own[k];
      });
      store(t + row, sum);
    }
  } else {
    std::fill_n(t, rows, 0.0);
    for (int k = 0; k < p; ++k)
      for (int i = 0; i < rows; ++i) t[i] += L[k * rows + i] * b[k];
  }
  for (int i = 0; i < m; ++i) x[position[i]] -= t[i];
}

template <int P>
inline void backward(const double* D, const Front& f, const int* position, double* x) {
  const int p = P ? P : f.pivots, m = f.others;
  const double* U = D + p * (p + f.rows);
  double* b = x + f.first;
  if constexpr (P > 0) {
    double own[P];
    std::copy_n(b, P, own);
    for (int j = 0; j < m; ++j, U += P) {
      const double xj = x[position[j]];
      unrolled<P>([&](auto k) { own[k] -= U[k] * xj; });
    }
    unrolled<P>([&](auto k) {
      unrolled<P>([&](auto i) {
        if constexpr (i > k) own[i] -= D[k * P + i] * own[k];
      });
    });
    unrolled<P>([&](auto back) {
      constexpr int k = P - 1 - back;
      own[k] *= D[k * P + k];
      unrolled<P>([&](auto i) {
        if constexpr (i < k) own[i] -= D[k * P + i] * own[k];
      });
    });
    std::copy_n(own, P, b);
  } else {
    for (int j = 0; j < m; ++j) {
      const double xj = x[position[j]];
      for (int k = 0; k < p; ++k) b[k] -= U[j * p + k] * xj;
    }
    for (int k = 0; k < p; ++k)
      for (int i = k + 1; i < p; ++i) b[i] -= D[k * p + i] * b[k];
    for (int k = p - 1; k >= 0; --k) {
      b[k] *= D[k * p + k];
      for (int i = 0; i < k; ++i) b[i] -= D[k * p + i] * b[k];
    }
  }
}

}  // namespace poinsot::block
