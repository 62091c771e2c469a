#include "integrators/stepping/branch_side.h"

#include <cmath>
#include <utility>
#include <vector>

#include "core/body_sizes.h"
#include "core/index.h"

namespace poinsot {
namespace {

constexpr Eigen::Index kMost = 150;  // rows: what is looked at costs their cube

}  // namespace

BranchSide::BranchSide(const Problem& problem) {
  const Eigen::Index rows = problem.nc(), columns = problem.nv();
  if (rows == 0 || rows > kMost || has_alternates(problem.model())) return;
  G_ = before_ = Eigen::MatrixXd::Zero(rows, columns);
  square_ = Eigen::MatrixXd::Zero(rows, rows);
  factors_ = Eigen::PartialPivLU<Eigen::MatrixXd>(rows);
  for (const Block& block : problem.pattern(MatrixKind::kinematic).blocks)
    for (int c = 0; c < block.cols; ++c) slots_.push_back((block.col + c) * static_cast<int>(rows) + block.row);
  const std::vector<double> sizes = body_sizes(problem.model());
  const Eigen::Index per_body = columns / static_cast<Eigen::Index>(sizes.size());
  weights_ = Eigen::VectorXd::Ones(columns);
  for (Eigen::Index first = 3; const double size : sizes) {  // what turns, as the way it makes there
    weights_.segment(first, per_body - 3).setConstant(1 / (size * size));
    first += per_body;
  }
}

bool BranchSide::reversed(Problem& problem, bool near) {
  if (slots_.empty()) return false;
  problem.assemble(MatrixKind::kinematic, {}, {}, {}, {}, slots_, {G_.data(), index(static_cast<int>(G_.size()))});
  bool other = false;
  if (std::exchange(known_, true) && near) {
    square_.noalias() = G_ * before_.transpose();
    factors_.compute(square_);
    bool negative = factors_.permutationP().determinant() < 0, regular = true;
    for (const double pivot : factors_.matrixLU().diagonal()) {
      negative ^= pivot < 0;
      regular = regular && std::abs(pivot) > 0;
    }
    other = regular && negative;
  }
  before_.noalias() = G_ * weights_.asDiagonal();
  return other;
}

}  // namespace poinsot
