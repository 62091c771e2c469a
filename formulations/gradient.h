// G of a problem by its entries, for analyses that are not part of a run.
#pragma once

#include <Eigen/SparseCore>
#include <functional>
#include <vector>

#include "formulations/problem.h"

namespace poinsot {

// Calls visit(row, column, value) for them; those that repeat add up. The problem stands at (t, q) and (·, v). Of large
// mechanisms a list of all would take half as much again as what it is made from.
void for_each_entry_of_gradient(Problem& problem, const std::function<void(int, int, double)>& visit);
std::vector<Eigen::Triplet<double>> gradient(Problem& problem);

}  // namespace poinsot
