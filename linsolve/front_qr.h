// A P = Q R of a sparse matrix by fronts, Q not kept: which columns depend on those before them, and how.
//
// The order P reduces fill. The front of a column is the dense matrix of all rows that begin there; one Householder
// reflection leaves a row of R, what remains is passed on to the next column of the front. A column of which no more
// than `tolerance` is left is dependent and gets no row of R (M. T. Heath, Some extensions of an algorithm for sparse
// linear least squares problems, 1982). Time and memory grow with the number of columns where fronts stay small.
//
// Which columns are kept is then decided by the order, and those may be barely independent. Where that matters a column
// of which little is left can wait while others of its fronts are taken, of which it may turn out a combination: a few
// at a time, for fronts to stay small. Columns of which enough is left may still lean on each other more and more along
// a mechanism, tenfold with each cell; the calmest are had where those wait, too, that numbers would grow by.
//
// Eigen's SparseQR takes 420 ms for Gᵀ of a ladder of 1000 bodies and 3.0 s for a chain's, this 3.7 and 1.9 ms (Intel
// Xeon, release build): it goes by columns, with no fronts.
#pragma once

#include <Eigen/Core>
#include <Eigen/SparseCore>
#include <cstddef>
#include <span>
#include <utility>
#include <vector>

namespace poinsot {

using SparseEntries = std::vector<std::pair<int, double>>;  // by index

class FrontQr {
 public:
  using Sparse = Eigen::SparseMatrix<double>;
  enum class Choice { by_order, clearest, calmest };
  // `left_out`: rows of A that are passed over. Null vectors can be asked for, and R is kept, where no more than `most`
  // columns are dependent.
  FrontQr(const Sparse& A, const std::vector<char>& left_out, double tolerance, Choice choice, std::size_t most);

  // Columns of A that depend on those before them in the order P, that of their elimination.
  const std::vector<int>& dependent() const { return dependent_; }
  // The most that was left of one of them, or that was held to be nothing on the way there: tolerances between that and
  // the one given lead to the same decomposition.
  double left() const { return most_left_; }
  // The largest |y| of Rᵀ y = b for signs b: rounding of A is so many times as large in what is left of a dependent
  // column. It grows with the length of a mechanism; where columns of which little is left are kept one after the other
  // it is their product.
  double growth() const { return growth_; }
  // Dependent columns of which something is left, and which lean on what has grown far: little is left of some row of
  // every long mechanism, wherever it stands, for loads can change so slowly along it.
  std::size_t stretched() const { return stretched_; }
  // A z = 0 up to the tolerance, for a dependent column: 1 there, and columns that are independent, sorted.
  SparseEntries null_vector(int column);
  // b z for the null vectors z of the dependent columns, in their order; b has a column for each of A. Without the
  // vectors, which may be long, by one pass over R: Rᵀ y = b, and b z = b_c − y r_c.
  struct Sums {
    Eigen::MatrixXd values;
    Eigen::VectorXd sizes;  // of the largest terms of each, added up
  };
  Sums times_null_vectors(const Eigen::MatrixXd& b);
  // Each row of b, which has a column for each of A, ← (A_KᵀA_K)⁻¹ b by R alone, K being the columns that are
  // independent; 0 at the others. Of what it is used for, x = A_K (A_KᵀA_K)⁻¹ b is as accurate as by Q (C. C. Paige, An
  // error analysis of a method for solving matrix equations, 1973).
  void solve_normal_equations(Eigen::MatrixXd& b);

 private:
  // What is left of it: from `top` and `first` on.
  struct Front {
    std::vector<int> places;      // of its columns by fill, ascending; of columns that wait, behind all of these
    std::vector<double> numbers;  // by columns, `height` of each
    Eigen::Index height = 0, top = 0, first = 0;
    int next = -1;  // the next part of the front that takes it in

    Eigen::Index width() const { return static_cast<Eigen::Index>(places.size()); }
    auto column(Eigen::Index k) { return Eigen::VectorXd::Map(numbers.data() + k * height, height); }
    auto left() {
      return Eigen::MatrixXd::Map(numbers.data() + first * height + top, height - top, width() - first,
                                  Eigen::OuterStride<>(height));
    }
  };
  // Parts of the front at a place, in the order they came.
  struct Parts {
    int first = -1, last = -1;
  };
  using RowMajor = Eigen::SparseMatrix<double, Eigen::RowMajor>;

  int assemble(int place, const RowMajor& A, std::span<const int> begins, const Parts& parts);
  void reduce(Front& front);
  int column_at(const Front& front, Eigen::Index k) const;
  double clarity(const Front& front, Eigen::Index k, double norm) const;
  void wait(Front& front);
  void settle_waiting(Front& front);
  void take(Front& front, Eigen::Index k, double norm);
  bool waits(int place) const { return place >= static_cast<int>(column_.size()); }
  void store_by_column();
  template <int Count>
  void solve_normal_equations_of(Eigen::MatrixXd& b) const;

  double tolerance_;
  Choice choice_;
  std::size_t most_;
  bool has_R_ = true;
  std::vector<int> column_, place_;  // column at a place, place of a column: by fill, at the end in the order P
  std::vector<int> order_;           // P, as far as it is known
  std::vector<int> dependent_;
  double most_left_ = 0;
  double growth_ = 0;
  std::size_t stretched_ = 0;
  std::vector<double> known_;  // by column: b less what the rows of R so far take off
  Eigen::MatrixXd leaning_;    // likewise of other signs, to choose the calmest by; y of the same would tell less
  std::vector<double> grown_;  // by column: the largest |y| of these rows
  std::vector<Front> fronts_;  // with room to be used again
  std::vector<int> free_;      // of these
  std::vector<int> local_;     // place within the front being assembled
  std::vector<double> work_;   // by place, zero between calls
  Eigen::VectorXd reflected_;
  struct Entry {
    int row, place;  // while it is made, `place` is the column
    double value;
  };
  std::vector<Entry> R_;
  std::vector<std::size_t> start_;  // of each place in R_, once it is sorted by column; rows ascending
};

}  // namespace poinsot
