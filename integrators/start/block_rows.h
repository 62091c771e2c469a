// The rows of a block (row_blocks.h) as unit vectors on its own bodies.
#pragma once

#include <Eigen/SparseCore>
#include <span>
#include <vector>

#include "integrators/start/row_space.h"
#include "linsolve/lists.h"

namespace poinsot {

class BlockRows {
 public:
  // `rows`: places in `space`.
  BlockRows(const RowSpace& space, std::vector<int> rows);

  // Takes the rows where `space` stands; all that follows but columns() is there.
  void stand(const RowSpace& space);

  std::size_t size() const { return rows_.size(); }
  int place_in_space(int k) const { return rows_[static_cast<std::size_t>(k)]; }
  Eigen::Index variables() const { return 6 * static_cast<Eigen::Index>(bodies_.size()); }
  // How many pairs of rows share a body: entries of G Gᵀ.
  double products() const;
  // Rows that share a body with row k, itself among them; some of them twice.
  template <typename Function>
  void for_each_beside(int k, Function&& function) const {
    for (const int body : ends_[static_cast<std::size_t>(k)].body)
      if (body >= 0)
        for (const int l : of_body_[body]) function(l);
  }
  double dot(int k, int l) const;
  // Calls function(k, l) for every pair of rows on a body, body by body.
  template <typename Function>
  void for_each_pair(Function&& function) const {
    for (int body = 0; body < of_body_.size(); ++body) {
      const std::span<const int> rows = of_body_[body];
      for (std::size_t k = 0; k < rows.size(); ++k)
        for (std::size_t l = k; l < rows.size(); ++l) function(rows[k], rows[l]);
    }
  }
  // Calls function(product) for what the body has to g_k · g_l, of the same pairs.
  template <typename Function>
  void for_each_product(Function&& function) const {
    const Part* part = parts_.data();
    for (int body = 0; body < of_body_.size(); ++body) {
      const std::size_t rows = of_body_[body].size();
      for (std::size_t k = 0; k < rows; ++k)
        for (std::size_t l = k; l < rows; ++l) function(part[k].dot(part[l]));
      part += rows;
    }
  }
  // f ← f + factor g_k
  void add(double factor, int k, Eigen::Ref<Eigen::VectorXd> f) const;
  // g_k · f
  double share(int k, const Eigen::Ref<const Eigen::VectorXd>& f) const;
  // Some of them, as columns of 6 numbers for each body.
  Eigen::SparseMatrix<double> columns(const RowSpace& space, std::span<const int> some) const;

 private:
  int place_of_body(int body) const;

  using Part = Eigen::Matrix<double, 6, 1>;
  struct Ends {
    int body[2] = {-1, -1};  // place of it, −1: none
    int part[2] = {-1, -1};
  };
  const Part& part(const Ends& of, int i) const { return parts_[static_cast<std::size_t>(of.part[i])]; }
  std::vector<int> rows_;    // of the space
  std::vector<int> bodies_;  // ascending
  Lists of_body_;            // rows
  std::vector<Ends> ends_;
  std::vector<Part> parts_;  // of rows, in the order of of_body_
  std::vector<int> to_;      // where the entries of the rows' columns go among the numbers of parts_
};

}  // namespace poinsot
