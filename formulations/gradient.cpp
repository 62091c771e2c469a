#include "formulations/gradient.h"

namespace poinsot {

void for_each_entry_of_gradient(Problem& problem, const std::function<void(int, int, double)>& visit) {
  const Pattern pattern = problem.pattern(MatrixKind::kinematic);
  std::vector<int> slots;  // every block column in a place of its own
  int size = 0;
  for (const Block& block : pattern.blocks) {
    for (int c = 0; c < block.cols; ++c, size += block.rows) slots.push_back(size);
  }
  std::vector<double> values(static_cast<std::size_t>(size));
  problem.assemble(MatrixKind::kinematic, {}, {}, {}, {}, slots, values);
  const double* value = values.data();
  for (const Block& block : pattern.blocks) {
    for (int c = 0; c < block.cols; ++c) {
      for (int r = 0; r < block.rows; ++r) visit(block.row + r, block.col + c, *value++);
    }
  }
}

std::vector<Eigen::Triplet<double>> gradient(Problem& problem) {
  std::vector<Eigen::Triplet<double>> entries;
  for_each_entry_of_gradient(problem, [&](int row, int col, double value) { entries.emplace_back(row, col, value); });
  return entries;
}

}  // namespace poinsot
