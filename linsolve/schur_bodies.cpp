#include "linsolve/schur_bodies.h"

#include <algorithm>
#include <cmath>

#include "core/index.h"

namespace poinsot {
namespace {

LinearStatus refused(const char* why, int unknown = -1) {
  return {LinearFailure::refused, unknown, "linear solver schur needs " + std::string(why)};
}

// LU with partial pivoting of K, n × n, in place, column by column, the diagonal inverted; the determinant, 0 where a
// pivot is nothing but rounding: beside every number its size without cancellation is carried along. `size`: room for
// n.
double factor(double* a, int n, int* swap, double* size) {
  constexpr double kCancelled = 1e-13;
  double determinant = 1;
  for (int j = 0; j < n; ++j) {
    double* column = a + j * n;
    for (int k = 0; k < j; ++k) std::swap(column[k], column[swap[k]]);
    for (int i = 0; i < n; ++i) size[i] = std::abs(column[i]);
    for (int k = 0; k < j; ++k)
      for (int i = k + 1; i < n; ++i) {
        const double change = a[k * n + i] * column[k];
        column[i] -= change;
        size[i] += std::abs(change);
      }
    int p = j;
    for (int i = j + 1; i < n; ++i)
      if (std::abs(column[i]) > std::abs(column[p])) p = i;
    if (!(std::abs(column[p]) > kCancelled * size[p])) return 0;
    swap[j] = p;
    if (p != j)
      for (int k = 0; k <= j; ++k) std::swap(a[k * n + j], a[k * n + p]);
    determinant *= column[j];
    column[j] = 1 / column[j];
    for (int i = j + 1; i < n; ++i) column[i] *= column[j];
  }
  return determinant;
}

// x ← K⁻¹ x
void solve(const double* a, int n, const int* swap, double* x) {
  for (int k = 0; k < n; ++k) std::swap(x[k], x[swap[k]]);
  for (int k = 0; k < n; ++k)
    for (int i = k + 1; i < n; ++i) x[i] -= a[k * n + i] * x[k];
  for (int k = n - 1; k >= 0; --k) {
    x[k] *= a[k * n + k];
    for (int i = 0; i < k; ++i) x[i] -= a[k * n + i] * x[k];
  }
}

}  // namespace

LinearStatus SchurBodies::analyze(const CscLayout& layout, std::span<const int> node, SparseLdlt& complement) {
  if (LinearStatus status = find_bodies(layout, node); !status.ok()) return status;
  number_entries(layout);
  std::vector<int> start;
  for (const Body& body : bodies_) start.push_back(body.first_row);
  if (complement.analyze(static_cast<int>(multiplier_.size()), start, row_)) return {};
  return {LinearFailure::refused, -1, "the factors have more entries than 32-bit indices can count"};
}

LinearStatus SchurBodies::find_bodies(const CscLayout& layout, std::span<const int> node) {
  const auto entries = [&](auto&& visit) {
    for (int j = 0; j < layout.n; ++j)
      for (int k = layout.start[index(j)]; k < layout.start[index(j) + 1]; ++k) visit(layout.row[index(k)], j);
  };
  std::vector<int> body_at(index(1 + *std::ranges::max_element(node)), -1);  // by node
  bodies_.clear(), multiplier_.clear();
  entries([&](int i, int j) {
    int& body = body_at[index(node[index(i)])];
    if (i == j && body < 0) body = static_cast<int>(bodies_.size()), bodies_.push_back({});
  });
  std::vector<std::pair<int, int>> members, rows;  // body, unknown; body, multiplier
  body_of_.assign(index(layout.n), -1), number_.assign(index(layout.n), 0);
  for (int k = 0; k < layout.n; ++k) {
    const int body = body_of_[index(k)] = body_at[index(node[index(k)])];
    if (body < 0) {
      number_[index(k)] = static_cast<int>(multiplier_.size());
      multiplier_.push_back(k);
    } else {
      number_[index(k)] = bodies_[index(body)].unknowns++;
      members.emplace_back(body, k);
    }
  }
  bool coupled_bodies = false, coupled_rows = false;
  entries([&](int i, int j) {
    const int bi = body_of_[index(i)], bj = body_of_[index(j)];
    coupled_rows = coupled_rows || (bi < 0 && bj < 0);
    coupled_bodies = coupled_bodies || (bi >= 0 && bj >= 0 && bi != bj);
    if (bi >= 0 && bj < 0) rows.emplace_back(bi, number_[index(j)]);
    if (bi < 0 && bj >= 0) rows.emplace_back(bj, number_[index(i)]);
  });
  if (multiplier_.empty() || coupled_rows)
    return refused("multipliers, which a matrix of kinematics does not have; klu takes it");
  if (coupled_bodies)
    return refused("a block of its own for each body, and here bodies are coupled; block takes this matrix");

  std::ranges::stable_sort(members, {}, &std::pair<int, int>::first);
  std::ranges::sort(rows);
  rows.erase(std::unique(rows.begin(), rows.end()), rows.end());
  unknown_.clear(), row_.clear();
  for (const auto& [body, unknown] : members) unknown_.push_back(unknown);
  for (const auto& [body, row] : rows) row_.push_back(row), ++bodies_[index(body)].rows;
  return {};
}

// Where the values of the matrix go in the bodies' stores; sizes everything.
void SchurBodies::number_entries(const CscLayout& layout) {
  Body next{};
  int most_numbers = 0;
  for (Body& body : bodies_) {
    next.unknowns = body.unknowns, next.rows = body.rows;
    body = next;
    next.first_unknown += body.unknowns, next.first_row += body.rows;
    next.store += std::int64_t{body.unknowns} * (body.unknowns + 2 * body.rows);
    most_numbers = std::max({most_numbers, body.rows * body.rows, body.unknowns});
  }
  bodies_.push_back(next);  // an end

  std::vector<std::pair<int, std::pair<int, int>>> placed;
  for (int j = 0; j < layout.n; ++j)
    for (int k = layout.start[index(j)]; k < layout.start[index(j) + 1]; ++k) {
      const int i = layout.row[index(k)], b = std::max(body_of_[index(i)], body_of_[index(j)]);
      const Body& body = bodies_[index(b)];
      const auto column = [&](int multiplier) {
        const auto first = row_.begin() + body.first_row;
        return static_cast<int>(std::lower_bound(first, first + body.rows, number_[index(multiplier)]) - first);
      };
      const int n = body.unknowns;
      int to = n * number_[index(j)] + number_[index(i)];
      if (body_of_[index(j)] < 0) to = n * (n + column(j)) + number_[index(i)];
      if (body_of_[index(i)] < 0) to = n * (n + body.rows + column(i)) + number_[index(j)];
      placed.push_back({b, {k, to}});
    }
  std::ranges::stable_sort(placed, {}, [](const auto& p) { return p.first; });
  entry_.clear();
  for (Body& body : bodies_) body.first_entry = 0;
  for (const auto& [body, places] : placed) {
    ++bodies_[index(body) + 1].first_entry;
    entry_.push_back(places);
  }
  for (std::size_t b = 1; b < bodies_.size(); ++b) bodies_[b].first_entry += bodies_[b - 1].first_entry;

  store_.assign(index(next.store), 0), swap_.assign(unknown_.size(), 0);
  determinant_.assign(bodies_.size() - 1, 0);
  z_.assign(index(most_numbers), 0), y_.assign(unknown_.size(), 0), lambda_.assign(multiplier_.size(), 0);
}

LinearStatus SchurBodies::eliminate(std::span<const double> values, SparseLdlt& complement) {
  constexpr double kSymmetric = 1e-8;  // relative asymmetry of S that one refinement still takes away
  std::ranges::fill(complement.values(), 0.0);
  const int* place = complement.places().data();
  for (std::size_t b = 0; b + 1 < bodies_.size(); ++b) {
    const Body& body = bodies_[b];
    const int n = body.unknowns, rows = body.rows;
    double *K = store_.data() + body.store, *Y = K + n * n, *C = Y + n * rows;
    std::fill(K, C + n * rows, 0.0);
    for (int e = body.first_entry; e < bodies_[b + 1].first_entry; ++e)
      K[entry_[index(e)].second] = values[index(entry_[index(e)].first)];
    int* swap = swap_.data() + body.first_unknown;
    determinant_[b] = factor(K, n, swap, z_.data());
    if (determinant_[b] == 0)
      return refused("inertia in every direction (block does not), and there is none",
                     unknown_[index(body.first_unknown)]);
    for (int r = 0; r < rows; ++r) solve(K, n, swap, Y + r * n);
    for (int j = 0; j < rows; ++j)
      for (int i = 0; i < rows; ++i) {
        double sum = 0;
        for (int k = 0; k < n; ++k) sum += C[i * n + k] * Y[j * n + k];
        z_[index(j * rows + i)] = sum;
      }
    for (int j = 0; j < rows; ++j) {
      const double zj = z_[index(j * rows + j)];
      if (zj < 0) return refused("positive definite matrices of bodies; block takes this matrix");
      for (int i = j; i < rows; ++i) {
        const double lower = z_[index(j * rows + i)], upper = z_[index(i * rows + j)];
        if (std::abs(lower - upper) > kSymmetric * std::sqrt(zj * std::abs(z_[index(i * rows + i)])))
          return refused("a symmetric matrix, and this one is not; block takes it");
        complement.values()[index(*place++)] += lower;
      }
    }
  }
  return {};
}

void SchurBodies::substitute(SparseLdlt& complement, std::span<double> b) {
  for (std::size_t k = 0; k < lambda_.size(); ++k) lambda_[k] = -b[index(multiplier_[k])];
  for (std::size_t k = 0; k + 1 < bodies_.size(); ++k) {
    const Body& body = bodies_[k];
    const int n = body.unknowns, rows = body.rows, *unknown = unknown_.data() + body.first_unknown;
    const double *K = store_.data() + body.store, *C = K + n * (n + rows);
    double* y = y_.data() + body.first_unknown;
    for (int i = 0; i < n; ++i) y[i] = b[index(unknown[i])];
    solve(K, n, swap_.data() + body.first_unknown, y);
    for (int r = 0; r < rows; ++r)
      for (int i = 0; i < n; ++i) lambda_[index(row_[index(body.first_row + r)])] += C[r * n + i] * y[i];
  }
  complement.solve(lambda_);
  for (std::size_t k = 0; k + 1 < bodies_.size(); ++k) {
    const Body& body = bodies_[k];
    const int n = body.unknowns, *unknown = unknown_.data() + body.first_unknown;
    const double* Y = store_.data() + body.store + n * n;
    double* y = y_.data() + body.first_unknown;
    for (int r = 0; r < body.rows; ++r)
      for (int i = 0; i < n; ++i) y[i] -= Y[r * n + i] * lambda_[index(row_[index(body.first_row + r)])];
    for (int i = 0; i < n; ++i) b[index(unknown[i])] = y[i];
  }
  for (std::size_t k = 0; k < lambda_.size(); ++k) b[index(multiplier_[k])] = lambda_[k];
}

}  // namespace poinsot
