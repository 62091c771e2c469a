// LU with partial pivoting of the full matrix; kernels of fixed size for the systems of one and two bodies.
//
// The order of rows is kept from one factorization to the next while it serves: multipliers up to kGrowth, pivots
// within a factor of kPivotRange of those it was chosen for. Measured (linear_solver_bench, AVX-512, klu's time over
// dense's, block's in brackets): heavy top 1.3 (1.4), one hinged rod 1.1 to 1.4 (1.3 to 1.5), driven pendulum 0.9
// to 1.0 (1.0), double pendulum 1.1 (1.3 to 1.8), larger ones 0.6 to 0.8. It beats klu on one body that can move, and
// block nowhere.
#include <algorithm>
#include <cmath>
#include <numeric>

#include "linsolve/back_ends.h"
#include "linsolve/dense_kernels.h"
#include "linsolve/scaled_lu.h"

namespace poinsot {
namespace {

constexpr int kLargest = 2000;  // 32 MB, and already seconds a factorization
constexpr double kGrowth = 10, kPivotRange = 100;

struct Kernels {
  int size;
  void (*factor)(double*, int, int*, double*);
  double (*refactor)(double*, int, double*);
  void (*solve)(const double*, int, const int*, const double*, double*, double*);
  void (*solve_transposed)(const double*, int, const int*, const double*, double*, double*);
};

template <int N>
constexpr Kernels kernels() {
  return {N, dense::factor<N>, dense::refactor<N>, dense::solve<N>, dense::solve_transposed<N>};
}

// One body in rA and reps, then rp: kinematics 6, 7; a spherical joint 9, 11; a hinge 11, 13; driven 12, 14. Two bodies
// on hinges: 22, 26. The last one takes every size.
constexpr Kernels kKernels[] = {kernels<6>(),  kernels<7>(),  kernels<9>(),  kernels<11>(), kernels<12>(),
                                kernels<13>(), kernels<14>(), kernels<22>(), kernels<26>(), kernels<0>()};

class Dense final : public ScaledLu {
 public:
  std::uint64_t orientation() override {
    bool negative = odd_order_;
    for (double inverse : inverse_) negative ^= inverse < 0;
    return negative ? 2 : 1;
  }

 private:
  LinearStatus do_symbolic() override {
    n_ = layout().n;
    if (n_ > kLargest)
      return {LinearFailure::refused, -1,
              "linear solver dense takes at most " + std::to_string(kLargest) + " unknowns, these are " +
                  std::to_string(n_)};
    kernels_ = std::ranges::find_if(kKernels, [&](const Kernels& k) { return k.size == n_ || k.size == 0; });
    lu_.assign(static_cast<std::size_t>(n_) * static_cast<std::size_t>(dense::stride(n_)), 0);
    order_.assign(static_cast<std::size_t>(n_), 0), place_ = order_;
    for (auto* v : {&inverse_, &chosen_}) v->assign(static_cast<std::size_t>(n_), 0);
    x_.assign(static_cast<std::size_t>(dense::stride(n_)), 0);
    statistics_.factor_nonzeros = std::int64_t{n_} * n_;
    return {};
  }

  LinearStatus do_fresh() override {
    std::iota(place_.begin(), place_.end(), 0);
    find_places();
    write();
    kernels_->factor(lu_.data(), n_, order_.data(), inverse_.data());
    for (std::size_t k = 0; k < order_.size(); ++k) {
      place_[static_cast<std::size_t>(order_[k])] = static_cast<int>(k);
      chosen_[k] = std::abs(inverse_[k]);
    }
    find_places();
    odd_order_ = odd(0, n_, [this](int k) { return order_[static_cast<std::size_t>(k)]; });
    return {};
  }

  bool do_refactor() override {
    write();
    bool good = kernels_->refactor(lu_.data(), n_, inverse_.data()) <= kGrowth;
    for (std::size_t k = 0; k < chosen_.size(); ++k) {
      const double now = std::abs(inverse_[k]), then = chosen_[k];
      good = good && now * kPivotRange >= then && now <= then * kPivotRange;
    }
    return good;
  }

  // The scaled matrix with its rows at their places.
  void write() {
    std::ranges::fill(lu_, 0.0);
    const std::span<const double> value = scaled();
    for (std::size_t k = 0; k < value.size(); ++k) lu_[to_[k]] = value[k];
  }

  void find_places() {
    const int *start = layout().start.data(), *row = layout().row.data(), *place = place_.data();
    to_.resize(scaled().size());
    for (int j = 0; j < n_; ++j)
      for (int k = start[j]; k < start[j + 1]; ++k)
        to_[static_cast<std::size_t>(k)] = static_cast<std::size_t>(j * dense::stride(n_) + place[row[k]]);
  }

  void do_substitute(std::span<double> b) override {
    kernels_->solve(lu_.data(), n_, order_.data(), inverse_.data(), x_.data(), b.data());
  }

  void do_substitute_transposed(std::span<double> b) override {
    kernels_->solve_transposed(lu_.data(), n_, order_.data(), inverse_.data(), x_.data(), b.data());
  }

  double pivot(int k) override { return column(k)[k]; }
  int pivot_column(int k) override { return k; }

  double* column(int j) {
    return lu_.data() + static_cast<std::size_t>(j) * static_cast<std::size_t>(dense::stride(n_));
  }

  int n_ = 0;
  const Kernels* kernels_ = nullptr;
  std::vector<double> lu_, inverse_, x_;
  std::vector<double> chosen_;      // 1/|pivot| when the order was chosen
  std::vector<int> order_, place_;  // row by position, position by row
  std::vector<std::size_t> to_;     // in lu_, by entry of the matrix
  bool odd_order_ = false;
};

}  // namespace

std::unique_ptr<LinearSolver> make_dense() {
  return std::make_unique<Dense>();
}

}  // namespace poinsot
