// G of a problem as entries (row, column, value), for analyses that are not part of a run.
#pragma once

#include <Eigen/SparseCore>
#include <vector>

#include "formulations/problem.h"

namespace poinsot {

// Entries that repeat add up. The problem stands at (t, q) and (·, v).
std::vector<Eigen::Triplet<double>> gradient(Problem& problem);

}  // namespace poinsot
