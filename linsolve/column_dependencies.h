// Which columns of a sparse matrix are combinations of earlier columns, and of which.
//
// The null space of A does not depend on the order in which it is found: it comes from a QR decomposition in an order
// that reduces fill (linsolve/front_qr.h). Its vectors are then combined until each ends at a column of its own, the
// dependent one, and contains no other dependent column; that form is unique. Rows of A that reach very many columns
// (a body with hundreds of joints) would couple all of these in one front; they are left out there, and the null
// vectors found without them are combined to those that such rows take to zero.
//
// Dependencies can be long: every loop of a long planar mechanism may come to lean on all loops before it. Their total
// length is bounded by kMostNamed; past it columns are named as dependent, but not always what they depend on.
#pragma once

#include <Eigen/SparseCore>
#include <cstdint>
#include <memory>
#include <vector>

#include "linsolve/front_qr.h"

namespace poinsot {

struct ColumnDependency {
  int column;
  std::vector<int> others;  // earlier columns it is a combination of, ascending; independent ones up to kMostNamed
};

inline constexpr std::size_t kMostNamed = 4'000'000;  // entries of null vectors: about 60 MB

struct ColumnDependencies {
  std::vector<ColumnDependency> columns;  // ascending
  bool named = true;  // false past kMostNamed: `others` are empty, and the columns are the last in some other order
};

// Columns of A have unit length or are zero; less than `tolerance` of one counts as nothing.
ColumnDependencies column_dependencies(const Eigen::SparseMatrix<double>& A, double tolerance);

// As many columns, ascending, without which the others are independent; not always those named above. Needs far less,
// and less again where it is not asked whether they are `enough` or more than that.
std::vector<int> dependent_columns(const Eigen::SparseMatrix<double>& A, double tolerance,
                                   std::size_t enough = SIZE_MAX);

// The same, but the others are kept for being clear, not for their order: as independent as one finds without vectors.
std::vector<int> clearest_dependent_columns(const Eigen::SparseMatrix<double>& A, double tolerance);

// The null space of A: a vector for each column that depends on others. `columns` are as many, ascending, without which
// the others are independent; where there are more than `most` of them (or of those that only wide rows keep from
// being dependent), or past kMostNamed, there are no vectors.
struct NullSpace {
  std::vector<int> columns;
  std::vector<SparseEntries> vectors;
  double from = 0;            // the least tolerance at which it is the same
  std::size_t stretched = 0;  // as good as dependent by the length of the mechanism: FrontQr::stretched
  // With its R, where that was asked for and no wide row was left out.
  std::shared_ptr<FrontQr> decomposition;
};
struct AlsoOfDecomposition {
  ColumnDependencies* named = nullptr;  // is given column_dependencies()
  bool keep = false;                    // NullSpace::decomposition
};
NullSpace null_space(const Eigen::SparseMatrix<double>& A, double tolerance, std::size_t most,
                     const AlsoOfDecomposition& also = {});

}  // namespace poinsot
