// Which of the rows of loops to set aside where some are combinations of others: as many as depend on others, of as
// few joints as keeps the rows left nearly as independent as any choice would (grouped_rows.h).
#pragma once

#include <Eigen/SparseCore>
#include <span>
#include <vector>

#include "core/model.h"
#include "linsolve/column_dependencies.h"

namespace poinsot {

// `rows`: of the model; `columns`: their unit vectors, 6 numbers for each body, with null space `null` at `tolerance`.
// Where that has no vectors each block of loops (row_blocks.h) is looked at by itself, by the decomposition of all
// where `null` has kept it; of one that alone has too many, `null.columns` are taken. Places in `rows`.
std::vector<int> rows_of_few_groups(const Model& model, std::span<const int> rows,
                                    const Eigen::SparseMatrix<double>& columns, NullSpace null, double tolerance);

// The null space of columns, with vectors unless there are more of them than are worth their time.
NullSpace few_null_vectors(const Eigen::SparseMatrix<double>& columns, double tolerance,
                           const AlsoOfDecomposition& also = {});
// It is without vectors.
bool many(const NullSpace& null);

}  // namespace poinsot
