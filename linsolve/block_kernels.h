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

// How far pivots are from those of a factorization that was examined: the least and the largest |u| / |u then|.
struct Drift {
  double least = 1, largest = 1, poison = 0;  // poison is 0 while all pivots are numbers

  void add(double ratio) {
    least = std::min(least, ratio);
    largest = std::max(largest, ratio);
    poison += ratio * 0;
  }
};

// D ← its factors, p × p. Candidates are compared in units of their rows, given by `weight` (permuted along). The
// diagonal is preferred while it is within a tenth of the largest: an order of rows that stays the same keeps the
// pivots comparable. True where rows were exchanged. `then` holds 1/|pivot| for Drift.
template <int P>
inline bool factor_pivots(double* D, int p_run, std::uint16_t* order, double* weight, const double* then,
                          Drift& drift) {
  const int p = P ? P : p_run;
  bool exchanged = false;
  for (int k = 0; k < p; ++k) {
    double* column = D + k * p;
    int best = k;
    double largest = std::abs(column[k]) * weight[k];
    const double diagonal = 10 * largest;
    for (int i = k + 1; i < p; ++i) {
      const double candidate = std::abs(column[i]) * weight[i];
      if (candidate > largest) largest = candidate, best = i;
    }
    if (largest > diagonal) {
      for (int j = 0; j < p; ++j) std::swap(D[j * p + k], D[j * p + best]);
      std::swap(weight[k], weight[best]);
      exchanged = true;
    } else {
      best = k;
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
  for (int k = 0; k < P; ++k)
    for (int c = 0; c < C; ++c) x[k][c] = load(L + k * rows + row + c * kLanes);
  for (int k = 0; k < P; ++k) {
    for (int j = 0; j < k; ++j)
      for (int c = 0; c < C; ++c) x[k][c] -= x[j][c] * D[k * P + j];
    for (int c = 0; c < C; ++c) x[k][c] *= D[k * P + k];
  }
  for (int k = P - 1; k >= 0; --k)
    for (int j = k + 1; j < P; ++j)
      for (int c = 0; c < C; ++c) x[k][c] -= x[j][c] * D[k * P + j];
  for (int k = 0; k < P; ++k)
    for (int c = 0; c < C; ++c) store(L + k * rows + row + c * kLanes, x[k][c]);
  for (int j = 0; j < m; ++j) {
    Vec w[C];
    for (int c = 0; c < C; ++c) w[c] = load(W + j * rows + row + c * kLanes);
    for (int k = 0; k < P; ++k)
      for (int c = 0; c < C; ++c) w[c] -= x[k][c] * U[j * P + k];
    for (int c = 0; c < C; ++c) store(out + j * rows + row + c * kLanes, w[c]);
  }
}

template <int P>
void eliminate(double* D, const Front& f, const double* W, double* out, std::uint16_t* order, double* weight,
               const double* then, Drift& drift) {
  const int p = P ? P : f.pivots, m = f.others, rows = f.rows;
  double *L = D + p * p, *U = L + p * rows;
  if (factor_pivots<P>(D, p, order, weight, then, drift))
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
}

// x: the permuted right-hand side; t: room for `rows` numbers.
template <int P>
inline void forward(const double* D, const Front& f, const int* position, const std::uint16_t* order, double* x,
                    double* t) {
  const int p = P ? P : f.pivots, rows = f.rows;
  double* b = x + f.first;
  exchange<P>(order, p, b);
  const double* L = D + p * p;
  if constexpr (P > 0) {
    for (int row = 0; row < rows; row += kLanes) {
      Vec sum = load(L + row) * b[0];
      for (int k = 1; k < P; ++k) sum += load(L + k * rows + row) * b[k];
      store(t + row, sum);
    }
  } else {
    std::fill_n(t, rows, 0.0);
    for (int k = 0; k < p; ++k)
      for (int i = 0; i < rows; ++i) t[i] += L[k * rows + i] * b[k];
  }
  for (int i = 0; i < f.others; ++i) x[position[i]] -= t[i];
}

template <int P>
inline void backward(const double* D, const Front& f, const int* position, double* x) {
  const int p = P ? P : f.pivots;
  double* b = x + f.first;
  const double* U = D + p * (p + f.rows);
  for (int j = 0; j < f.others; ++j) {
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

}  // namespace poinsot::block
