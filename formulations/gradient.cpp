#include "formulations/gradient.h"

namespace poinsot {

std::vector<Eigen::Triplet<double>> gradient(Problem& problem) {
  const Pattern pattern = problem.pattern(MatrixKind::kinematic);
  std::vector<int> slots;  // every block column in a place of its own
  int size = 0;
  for (const Block& block : pattern.blocks) {
    for (int c = 0; c < block.cols; ++c, size += block.rows) slots.push_back(size);
  }
  std::vector<double> values(static_cast<std::size_t>(size));
  problem.assemble(MatrixKind::kinematic, {}, {}, {}, {}, slots, values);
  std::vector<Eigen::Triplet<double>> entries;
  entries.reserve(values.size());
  for (const Block& block : pattern.blocks) {
    for (int c = 0; c < block.cols; ++c) {
      for (int r = 0; r < block.rows; ++r) entries.emplace_back(block.row + r, block.col + c, values[entries.size()]);
    }
  }
  return entries;
}

}  // namespace poinsot
