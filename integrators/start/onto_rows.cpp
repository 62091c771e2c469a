#include "integrators/start/onto_rows.h"

#include <algorithm>
#include <cmath>
#include <random>
#include <utility>

namespace poinsot {
namespace {

// Of a row that is free beside far more is left in sums with random coefficients, but for a chance of one in 1e10.
constexpr double kFollows = 1e-8;
constexpr int kSums = 3;

}  // namespace

OntoRows::OntoRows(RowSpace& space, std::vector<int> without, std::span<const double> sizes)
    : space_(space), without_(std::move(without)), sizes_(sizes) {}

bool OntoRows::all_follow(double t) {
  return sums_follow(t) || (be_exact(t) && sums_follow(t));
}

// Of sums of the rows left out with random coefficients all is in the span of the others.
bool OntoRows::sums_follow(double t) {
  std::mt19937 random(1);
  std::uniform_real_distribution<double> size(1, 2);
  Eigen::MatrixXd sums = Eigen::MatrixXd::Zero(kSums, space_.columns().rows());
  for (int k = 0; k < kSums; ++k)
    for (const int row : without_) {
      const auto column = std::ranges::lower_bound(space_.rows(), row) - space_.rows().begin();
      const double factor = (random() % 2 == 0 ? 1 : -1) * size(random);
      for (Eigen::SparseMatrix<double>::InnerIterator it(space_.columns(), column); it; ++it)
        sums(k, it.row()) += factor * it.value() / scaled(it.row());
    }
  if (!leave_free(t, sums)) return false;
  for (Eigen::Index j = 0; j < sums.cols(); ++j)
    if (!((scaled(j) * sums.col(j)).cwiseAbs().maxCoeff() < kFollows)) return false;
  return true;
}

}  // namespace poinsot
