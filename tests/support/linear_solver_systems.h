// Linear systems to test linear solvers on: the saddle points [M Gᵀ; G 0] of made-up mechanisms, with their structure.
//
// Bodies come first, b unknowns each, then the rows of the groups of constraints; rp-like bodies have a normalization
// row each behind those, which belongs to the body's node. Everything is seeded.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <random>
#include <span>
#include <string>
#include <vector>

#include "linsolve/linear_solver.h"
#include "linsolve/pattern.h"

namespace poinsot::test {

// A matrix as an assembler writes it: a value for each entry of each block, column by column, blocks in pattern order.
struct SampleSystem {
  std::string name;
  Pattern pattern;
  std::vector<double> values;

  void add(const Block& block, std::span<const double> entries) {
    pattern.blocks.push_back(block);
    values.insert(values.end(), entries.begin(), entries.end());
  }

  // The values of block k, column by column.
  std::span<double> block(std::size_t k) {
    std::size_t first = 0;
    for (std::size_t m = 0; m < k; ++m) first += size(pattern.blocks[m]);
    return std::span(values).subspan(first, size(pattern.blocks[k]));
  }

  // y ← A x in long double.
  std::vector<long double> times(std::span<const double> x) const {
    std::vector<long double> y(static_cast<std::size_t>(pattern.n), 0.0L);
    std::size_t v = 0;
    for (const Block& b : pattern.blocks)
      for (int j = b.col; j < b.col + b.cols; ++j)
        for (int i = b.row; i < b.row + b.rows; ++i)
          y[static_cast<std::size_t>(i)] +=
              static_cast<long double>(values[v++]) * static_cast<long double>(x[static_cast<std::size_t>(j)]);
    return y;
  }

 private:
  static std::size_t size(const Block& b) {
    return static_cast<std::size_t>(b.rows) * static_cast<std::size_t>(b.cols);
  }
};

// Writes the system where the solver said, as an assembler does.
template <class Solver>  // what has slots() and values()
void write(const SampleSystem& system, Solver& solver) {
  std::ranges::fill(solver.values(), 0.0);
  std::size_t v = 0, c = 0;
  for (const Block& b : system.pattern.blocks)
    for (int j = 0; j < b.cols; ++j, ++c)
      for (int i = 0; i < b.rows; ++i)
        solver.values()[static_cast<std::size_t>(solver.slots()[c] + i)] += system.values[v++];
}

inline std::vector<double> random_vector(int n, std::mt19937_64& random) {
  std::normal_distribution<double> normal;
  std::vector<double> b(static_cast<std::size_t>(n));
  for (double& x : b) x = normal(random);
  return b;
}

enum class BodyKind { six, seven };  // 3 + 3 unknowns; 3 + 4 with a normalization row

struct RowsBetween {
  int i, j;  // bodies, i may be −1: the ground
  int rows;
};

struct Mechanism {
  std::string name;
  int bodies = 0;
  std::vector<RowsBetween> joints;
};

inline Mechanism chain(int bodies, int rows) {
  Mechanism m{"chain_" + std::to_string(bodies) + "x" + std::to_string(rows), bodies, {}};
  for (int k = 0; k < bodies; ++k) m.joints.push_back({k - 1, k, rows});
  return m;
}

inline Mechanism tree(int bodies, std::mt19937_64& random) {
  Mechanism m{"tree_" + std::to_string(bodies), bodies, {}};
  for (int k = 0; k < bodies; ++k)
    m.joints.push_back(
        {std::uniform_int_distribution(-1, k - 1)(random), k, std::uniform_int_distribution(1, 6)(random)});
  return m;
}

// Two rails with rungs: every rung closes a loop.
inline Mechanism ladder(int rungs) {
  Mechanism m{"ladder_" + std::to_string(rungs), 3 * rungs, {}};
  for (int k = 0; k < rungs; ++k) {
    const int left = 3 * k, right = left + 1, rung = left + 2;
    m.joints.push_back({k ? left - 3 : -1, left, 3});
    m.joints.push_back({k ? right - 3 : -1, right, 3});
    m.joints.push_back({left, rung, 3});
    m.joints.push_back({right, rung, 3});
  }
  return m;
}

// M: symmetric positive definite plus an unsymmetric perturbation, as in an exact Newton matrix; for the 4 orientation
// unknowns of `seven` only of rank 3, with the null vector the normalization row forbids. G: random rows.
inline SampleSystem saddle_point(const Mechanism& mechanism, BodyKind kind, std::mt19937_64& random) {
  std::normal_distribution<double> normal;
  const int b = kind == BodyKind::six ? 6 : 7, dim = b - 3;
  SampleSystem s;
  s.name = mechanism.name + (kind == BodyKind::six ? "_six" : "_seven");
  int rows = 0;
  for (const RowsBetween& joint : mechanism.joints) rows += joint.rows;
  const int normalization = b * mechanism.bodies + rows;
  s.pattern.n = normalization + (kind == BodyKind::seven ? mechanism.bodies : 0);

  for (int k = 0; k < mechanism.bodies; ++k) {
    std::vector<double> p(4), matrix(static_cast<std::size_t>(b * b), 0.0), half(3 * 4);
    double norm = 0;
    for (double& x : p) x = normal(random), norm += x * x;
    for (double& x : p) x /= std::sqrt(norm);
    for (double& x : half) x = normal(random);
    if (kind == BodyKind::seven)  // rows of `half` orthogonal to p
      for (int r = 0; r < 3; ++r) {
        double dot = 0;
        for (int c = 0; c < 4; ++c) dot += half[static_cast<std::size_t>(4 * r + c)] * p[static_cast<std::size_t>(c)];
        for (int c = 0; c < 4; ++c) half[static_cast<std::size_t>(4 * r + c)] -= dot * p[static_cast<std::size_t>(c)];
      }
    const double mass = std::exp(normal(random));
    for (int c = 0; c < b; ++c)
      for (int r = 0; r < b; ++r) {
        double& m = matrix[static_cast<std::size_t>(c * b + r)];
        if (r < 3 && c < 3) m = r == c ? mass : 0;
        if (r >= 3 && c >= 3) {
          for (int l = 0; l < 3; ++l)
            m += half[static_cast<std::size_t>(4 * l + r - 3)] * half[static_cast<std::size_t>(4 * l + c - 3)];
          if (kind == BodyKind::six) m += (r == c ? 0.1 : 0) + 0.01 * normal(random);
        }
      }
    s.add({b * k, b * k, b, b}, matrix);
    if (kind == BodyKind::seven) {
      s.add({b * k + 3, normalization + k, dim, 1}, p);
      s.add({normalization + k, b * k + 3, 1, dim}, p);
    }
    for (int c = 0; c < b; ++c) s.pattern.node.push_back(k);
  }
  int row = b * mechanism.bodies, group = mechanism.bodies;
  for (const RowsBetween& joint : mechanism.joints) {
    for (const int body : {joint.i, joint.j}) {
      if (body < 0) continue;
      std::vector<double> g(static_cast<std::size_t>(joint.rows * b)), transposed(g.size());
      for (int c = 0; c < b; ++c)
        for (int r = 0; r < joint.rows; ++r)
          transposed[static_cast<std::size_t>(r * b + c)] = g[static_cast<std::size_t>(c * joint.rows + r)] =
              normal(random);
      s.add({row, b * body, joint.rows, b}, g);
      s.add({b * body, row, b, joint.rows}, transposed);
    }
    for (int r = 0; r < joint.rows; ++r) s.pattern.node.push_back(group);
    row += joint.rows;
    ++group;
  }
  for (int k = 0; normalization + k < s.pattern.n; ++k) s.pattern.node.push_back(k);
  return s;
}

// LU in long double of the row-equilibrated dense matrix, with partial pivoting.
class Reference {
 public:
  explicit Reference(const SampleSystem& s)
      : n_(static_cast<std::size_t>(s.pattern.n)), a_(n_ * n_, 0.0L), scale_(n_, 0.0L), order_(n_) {
    std::size_t v = 0;
    for (const Block& b : s.pattern.blocks)
      for (int j = b.col; j < b.col + b.cols; ++j)
        for (int i = b.row; i < b.row + b.rows; ++i)
          a(static_cast<std::size_t>(i), static_cast<std::size_t>(j)) += static_cast<long double>(s.values[v++]);
    for (std::size_t i = 0; i < n_; ++i) {
      for (std::size_t j = 0; j < n_; ++j) scale_[i] = std::max(scale_[i], std::abs(a(i, j)));
      for (std::size_t j = 0; j < n_; ++j) a(i, j) /= scale_[i];
    }
    for (std::size_t k = 0; k < n_; ++k) {
      std::size_t p = k;
      for (std::size_t i = k + 1; i < n_; ++i)
        if (std::abs(a(i, k)) > std::abs(a(p, k))) p = i;
      order_[k] = p;
      for (std::size_t j = 0; j < n_ && p != k; ++j) std::swap(a(k, j), a(p, j));
      for (std::size_t i = k + 1; i < n_; ++i) {
        const long double l = a(i, k) /= a(k, k);
        if (l == 0) continue;
        for (std::size_t j = k + 1; j < n_; ++j) a(i, j) -= l * a(k, j);
      }
    }
  }

  template <class T>
  std::vector<long double> solve(std::span<const T> b) const {
    std::vector<long double> x(b.begin(), b.end());
    for (std::size_t i = 0; i < n_; ++i) x[i] /= scale_[i];
    for (std::size_t k = 0; k < n_; ++k) std::swap(x[k], x[order_[k]]);
    for (std::size_t i = 0; i < n_; ++i)
      for (std::size_t j = 0; j < i; ++j) x[i] -= a(i, j) * x[j];
    for (std::size_t i = n_; i-- > 0;) {
      for (std::size_t j = i + 1; j < n_; ++j) x[i] -= a(i, j) * x[j];
      x[i] /= a(i, i);
    }
    return x;
  }

 private:
  long double& a(std::size_t i, std::size_t j) { return a_[i * n_ + j]; }
  const long double& a(std::size_t i, std::size_t j) const { return a_[i * n_ + j]; }

  std::size_t n_;
  std::vector<long double> a_, scale_;
  std::vector<std::size_t> order_;
};

// Masses from 1e-5 to 1e3 and constraint rows over h², h = 1e-6.
inline SampleSystem badly_scaled(const Mechanism& mechanism, BodyKind kind, bool both, std::mt19937_64& random) {
  SampleSystem s = saddle_point(mechanism, kind, random);
  const double h = 1e-6;
  for (std::size_t m = 0; m < s.pattern.blocks.size(); ++m) {
    const Block& b = s.pattern.blocks[m];
    const int row = s.pattern.node[static_cast<std::size_t>(b.row)],
              col = s.pattern.node[static_cast<std::size_t>(b.col)];
    double factor = 1;
    if (row == col && b.rows == b.cols) factor = row % 3 == 0 ? 1e-5 : row % 3 == 1 ? 1 : 1e3;
    if (row != col && row >= mechanism.bodies) factor = 1 / (h * h);
    if (row != col && col >= mechanism.bodies && both) factor = 1 / (h * h);
    for (double& x : s.block(m)) x *= factor;
  }
  return s;
}

}  // namespace poinsot::test
