// Products of a few rows with a sparse matrix, by one pass over it for all of them; Eigen makes one for each row.
#pragma once

#include <Eigen/Core>
#include <Eigen/SparseCore>
#include <type_traits>

namespace poinsot {

// Calls f with the number of rows as a type: of a few it is known where the code is compiled.
template <class F>
void with_count(Eigen::Index rows, F&& f) {
  if (rows == 1)
    f(std::integral_constant<int, 1>());
  else if (rows == 3)
    f(std::integral_constant<int, 3>());
  else
    f(std::integral_constant<int, Eigen::Dynamic>());
}

// x A.
inline Eigen::MatrixXd times(const Eigen::MatrixXd& x, const Eigen::SparseMatrix<double>& A) {
  Eigen::MatrixXd product = Eigen::MatrixXd::Zero(x.rows(), A.cols());
  with_count(x.rows(), [&]<int Count>(std::integral_constant<int, Count>) {
    using Rows = Eigen::Map<const Eigen::Matrix<double, Count, Eigen::Dynamic>>;
    const Rows from(x.data(), x.rows(), x.cols());
    for (Eigen::Index k = 0; k < A.cols(); ++k) {
      Eigen::Matrix<double, Count, 1> sum = Eigen::Matrix<double, Count, 1>::Zero(x.rows());
      for (Eigen::SparseMatrix<double>::InnerIterator it(A, k); it; ++it) sum += it.value() * from.col(it.row());
      product.col(k) = sum;
    }
  });
  return product;
}

// x Aᵀ.
inline Eigen::MatrixXd times_transposed(const Eigen::MatrixXd& x, const Eigen::SparseMatrix<double>& A) {
  Eigen::MatrixXd product = Eigen::MatrixXd::Zero(x.rows(), A.rows());
  with_count(x.rows(), [&]<int Count>(std::integral_constant<int, Count>) {
    Eigen::Map<Eigen::Matrix<double, Count, Eigen::Dynamic>> to(product.data(), product.rows(), product.cols());
    for (Eigen::Index k = 0; k < A.cols(); ++k) {
      const Eigen::Matrix<double, Count, 1> from = x.col(k);
      for (Eigen::SparseMatrix<double>::InnerIterator it(A, k); it; ++it) to.col(it.row()) += it.value() * from;
    }
  });
  return product;
}

}  // namespace poinsot
