// Which columns of a sparse matrix are combinations of earlier columns, and of which.
//
// The null space of A does not depend on the order in which it is found: it comes from a QR decomposition in an order
// that reduces fill (linsolve/front_qr.h). Its vectors are then combined until each ends at a column of its own, the
// dependent one, and contains no other dependent column; that form is unique. Rows of A that reach very many columns
// (a body with hundreds of joints) would couple all of these in one front; they are left out there, and the null
// vectors found without them are combined to those that such rows take to zero.
#pragma once

#include <Eigen/SparseCore>
#include <vector>

namespace poinsot {

struct ColumnDependency {
  int column;
  std::vector<int> others;  // independent columns before it, ascending
};

// Columns of A have unit length or are zero; less than `tolerance` of one counts as nothing. By column, ascending.
std::vector<ColumnDependency> column_dependencies(const Eigen::SparseMatrix<double>& A, double tolerance);

}  // namespace poinsot
