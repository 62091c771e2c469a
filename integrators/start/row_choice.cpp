#include "integrators/start/row_choice.h"

#include <Eigen/Cholesky>
#include <Eigen/SparseCholesky>
#include <algorithm>
#include <cmath>
#include <utility>

#include "core/index.h"

namespace poinsot {
namespace {

using Sparse = Eigen::SparseMatrix<double>;

// Coefficient at which rows are chosen anew. Two directions at right angles of which one is set aside have the
// coefficient cot α when the redundant one is α from the row that is kept in its place: 2 leaves 0.46 rad to go.
constexpr double kWorn = 2;
constexpr double kNothing = 1e-12;    // of a coefficient beside the row set aside
constexpr Eigen::Index kDense = 120;  // rows up to which full matrices are faster

// C with Kᵀ K C = Kᵀ D in the least-squares sense, refined once; false where K's columns are not independent.
template <class Factorization>
bool least_squares(const Factorization& gram, const Sparse& K, const Sparse& D, Eigen::MatrixXd& C) {
  if (gram.info() != Eigen::Success) return false;
  C = gram.solve(Eigen::MatrixXd(K.transpose() * D));
  const Eigen::MatrixXd left = Eigen::MatrixXd(D) - K * C;
  C += gram.solve(K.transpose() * left);
  return C.allFinite();
}

}  // namespace

RowChoice::RowChoice(std::shared_ptr<const Model> model, std::vector<int> rows, std::vector<int> aside)
    : space_(std::move(model), std::move(rows)), aside_(std::move(aside)) {}

std::vector<SparseEntries> RowChoice::unit_null_vectors(double t, std::span<const BodyState> states) {
  space_.stand(t, states);
  if (aside_.size() > kMost) return {};
  const Sparse& columns = space_.columns();
  std::vector<int> kept, left_out;
  for (int k = 0; k < columns.cols(); ++k)
    (std::ranges::binary_search(aside_, space_.rows()[index(k)]) ? left_out : kept).push_back(k);
  const auto part = [&](const std::vector<int>& some) {
    Sparse of(columns.rows(), static_cast<Eigen::Index>(some.size()));
    std::vector<Eigen::Triplet<double>> entries;
    for (std::size_t c = 0; c < some.size(); ++c)
      for (Sparse::InnerIterator it(columns, some[c]); it; ++it)
        if (it.value() != 0) entries.emplace_back(static_cast<int>(it.row()), static_cast<int>(c), it.value());
    of.setFromTriplets(entries.begin(), entries.end());
    return of;
  };
  const Sparse K = part(kept), D = part(left_out);
  Eigen::MatrixXd C;
  const Sparse gram = K.transpose() * K;
  bool good = false;
  if (K.cols() <= kDense) {
    good = least_squares(Eigen::LLT<Eigen::MatrixXd>{Eigen::MatrixXd(gram)}, K, D, C);
  } else {
    good = least_squares(Eigen::SimplicialLDLT<Sparse>(gram), K, D, C);
  }
  if (!good) return {};
  std::vector<SparseEntries> vectors(left_out.size());
  for (std::size_t d = 0; d < left_out.size(); ++d) {
    for (std::size_t k = 0; k < kept.size(); ++k) {
      const double c = C(static_cast<Eigen::Index>(k), static_cast<Eigen::Index>(d));
      if (std::abs(c) > kNothing) vectors[d].emplace_back(kept[k], -c);
    }
    vectors[d].emplace_back(left_out[d], 1.0);
    std::ranges::sort(vectors[d]);
  }
  return vectors;
}

bool RowChoice::renew(double t, std::span<const BodyState> states) {
  std::vector<SparseEntries> vectors = unit_null_vectors(t, states);
  double largest = 0;
  for (const SparseEntries& z : vectors)
    for (const auto& [row, value] : z) largest = std::max(largest, std::abs(value));
  if (!(largest > kWorn)) return false;
  std::vector<int> chosen = separate(std::move(vectors));
  for (int& k : chosen) k = space_.rows()[index(k)];
  std::ranges::sort(chosen);
  if (chosen == aside_) return false;
  aside_ = std::move(chosen);
  return true;
}

double RowChoice::size_of(int row) const {
  const auto k = static_cast<std::size_t>(std::ranges::lower_bound(space_.rows(), row) - space_.rows().begin());
  return space_.size_of_row(k) * space_.lengths()[k];
}

std::vector<SparseEntries> RowChoice::null_vectors(double t, std::span<const BodyState> states) {
  std::vector<SparseEntries> vectors = unit_null_vectors(t, states);
  for (SparseEntries& z : vectors)
    for (auto& [row, value] : z) {
      value /= space_.lengths()[index(row)];
      row = space_.rows()[index(row)];
    }
  return vectors;
}

}  // namespace poinsot
