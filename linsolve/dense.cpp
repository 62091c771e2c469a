// LU with partial pivoting of the full matrix, columns stored one after the other: P A = L U.
#include <algorithm>
#include <cmath>

#include "linsolve/back_ends.h"
#include "linsolve/scaled_lu.h"

namespace poinsot {
namespace {

constexpr std::size_t kLargest = 2000;  // 32 MB, and already seconds a factorization

class Dense final : public ScaledLu {
 private:
  LinearStatus do_symbolic() override {
    n_ = static_cast<std::size_t>(layout().n);
    if (n_ > kLargest)
      return {LinearFailure::refused, -1,
              "linear solver dense takes at most " + std::to_string(kLargest) + " unknowns, these are " +
                  std::to_string(n_) + "; klu takes them"};
    lu_.assign(n_ * n_, 0);
    swap_.assign(n_, 0);
    statistics_.factor_nonzeros = static_cast<std::int64_t>(n_ * n_);
    return {};
  }

  LinearStatus do_fresh() override {
    std::ranges::fill(lu_, 0.0);
    for (std::size_t j = 0; j < n_; ++j)
      for (auto k = static_cast<std::size_t>(layout().start[j]); k < static_cast<std::size_t>(layout().start[j + 1]);
           ++k)
        column(j)[layout().row[k]] = scaled()[k];

    for (std::size_t k = 0; k < n_; ++k) {
      double* ck = column(k);
      std::size_t p = k;
      for (std::size_t i = k + 1; i < n_; ++i)
        if (std::abs(ck[i]) > std::abs(ck[p])) p = i;
      swap_[k] = p;
      if (ck[p] == 0) continue;
      if (p != k)
        for (std::size_t j = 0; j < n_; ++j) std::swap(column(j)[k], column(j)[p]);
      const double inverse = 1 / ck[k];
      for (std::size_t i = k + 1; i < n_; ++i) ck[i] *= inverse;
      for (std::size_t j = k + 1; j < n_; ++j) {
        double* cj = column(j);
        const double u = cj[k];
        if (u == 0) continue;  // most of a saddle point
        for (std::size_t i = k + 1; i < n_; ++i) cj[i] -= ck[i] * u;
      }
    }
    return {};
  }

  void do_substitute(std::span<double> x) override {
    for (std::size_t k = 0; k < n_; ++k) std::swap(x[k], x[swap_[k]]);
    for (std::size_t k = 0; k < n_; ++k)
      for (std::size_t i = k + 1; i < n_; ++i) x[i] -= column(k)[i] * x[k];
    for (std::size_t k = n_; k-- > 0;) {
      x[k] /= column(k)[k];
      for (std::size_t i = 0; i < k; ++i) x[i] -= column(k)[i] * x[k];
    }
  }

  double pivot(int k) override { return column(static_cast<std::size_t>(k))[k]; }
  int pivot_column(int k) override { return k; }

  double* column(std::size_t j) { return lu_.data() + j * n_; }

  std::size_t n_ = 0;
  std::vector<double> lu_;
  std::vector<std::size_t> swap_;
};

}  // namespace

std::unique_ptr<LinearSolver> make_dense() {
  return std::make_unique<Dense>();
}

}  // namespace poinsot
