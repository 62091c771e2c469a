// The constraint rows' blocks in the matrices: G with its transpose, ∂(G v − ν)/∂q, and the velocity rows of a step.
//
// A row of G is the gradient (−g, e_i | g, e_j) of formulations/rows.h with e pulled back by Ŵᵀ; a coincidence's three
// rows are ± [I, E(s) Ŵ]. A sink takes first(row, col, matrix) and
// add(row, col, matrix) calls (formulations/blocks.h).
#pragma once

#include <vector>

#include "core/index.h"
#include "formulations/problem.h"
#include "formulations/rate_rows.h"

namespace poinsot {

template <class F, class T, class Sink>
class RowBlocks {
 public:
  using C = Configuration<F, T>;
  using Ambient = typename C::Ambient;
  using X = Eigen::Matrix<T, F::m, 1>;
  using XX = Eigen::Matrix<T, F::m, F::m>;
  using Gradient = typename Rows<F, T>::Gradient;
  static constexpr int kV = C::kVelocities;

  RowBlocks(const C& c, Sink& sink) : c_(c), sink_(sink) {}

  // G at rows `first_row` on, and Gᵀ beside it.
  void gradients(int first_row, bool transposed) const {
    const auto write = [&](const Gradient& g, auto has_r, const T&) {
      if (g.i != kGround) gradient_blocks<decltype(has_r)::value>(first_row + g.row, g.i, -g.g, g.ei, transposed);
      if (g.j != kGround) gradient_blocks<decltype(has_r)::value>(first_row + g.row, g.j, g.g, g.ej, transposed);
    };
    Rows<F, T>::scalar(c_, write);
    for (const CoincidenceRows& k : c_.elements->coincidences) {
      if (k.i != kGround) coincidence_blocks(first_row + k.row, k.i, k.p, T(-1), transposed);
      if (k.j != kGround) coincidence_blocks(first_row + k.row, k.j, k.q, T(1), transposed);
    }
    Rows<F, T>::velocity(c_, write);
    if constexpr (F::normalized) {
      if (transposed) return;  // beside the inertia there
      for (int b = 0; b < c_.elements->nb; ++b) {
        sink_.first(c_.elements->rows + b, b * kV + 3, Eigen::Matrix<T, 1, F::m>(c_.p(b).transpose()));
      }
    }
  }

  // A velocity row of the step is (Ψv − f)/velocity. Its matrix row Ψ T⁻¹ + position/velocity ∂(Ψv)/∂q differs from the
  // gradient Ψ written with the others by what is added here. Without T_inverse T = I.
  void velocity_rows(const StepScale& scale, int first_row, const std::vector<XX>& T_inverse) const {
    const T by = T(scale.position / scale.velocity);
    const auto write = [&](int row, int body, const X& variation, const Vec3<T>& point, const Vec3<T>& direction) {
      if (body == kGround) return;
      X x = by * variation;
      if constexpr (F::space == CoordinateSpace::lie_group) {
        if (!T_inverse.empty()) {
          const X psi = c_.at[index(body)].W().transpose() * C::Et_times(point, direction);
          x += T_inverse[index(body)].transpose() * psi - psi;
        }
      }
      sink_.add(first_row + row, body * kV + 3, Eigen::Matrix<T, 1, F::m>(x.transpose()));
    };
    auto k = c_.elements->pfaffian.begin();
    RateRows<F, T>::velocity(c_, [&](const auto& variation, auto) {
      const Vec3<T>& a = c_.s[index(k->a)];
      write(k->row, k->i, variation.xi, c_.s[index(k->p)], -a);
      write(k->row, k->j, variation.xj, c_.s[index(k->q)], a);
      ++k;
    });
  }

  // ∂(G v − ν)/∂q; needs compute_s_dot.
  void rates() const {
    const auto write = [&](const auto& variation, auto has_r) {
      const auto on = [&](int body, const Vec3<T>& g, const X& x) {
        if (body == kGround) return;
        if constexpr (has_r) sink_.first(variation.row, body * kV, Eigen::Matrix<T, 1, 3>(g.transpose()));
        sink_.first(variation.row, body * kV + 3, Eigen::Matrix<T, 1, F::m>(x.transpose()));
      };
      on(variation.i, -variation.g, variation.xi);
      on(variation.j, variation.g, variation.xj);
    };
    RateRows<F, T>::holonomic(c_, write);
    RateRows<F, T>::velocity(c_, write);
    if constexpr (F::normalized) {
      for (int b = 0; b < c_.elements->nb; ++b) {
        sink_.first(c_.elements->rows + b, b * kV + 3,
                    Eigen::Matrix<T, 1, F::m>(Eigen::Map<const X>(c_.xd(b)).transpose()));
      }
    }
  }

 private:
  // ± [I, E(s) Ŵ]
  void coincidence_blocks(int row, int body, int point, const T& sign, bool transposed) const {
    using GX = Eigen::Matrix<T, 3, F::m>;
    const Eigen::Matrix<T, 1, 1> one(sign);
    const GX x = sign * C::E_times(c_.s[index(point)], c_.at[index(body)].W());
    for (int l = 0; l < 3; ++l) sink_.first(row + l, body * kV + l, one);
    sink_.first(row, body * kV + 3, x);
    if (!transposed) return;
    for (int l = 0; l < 3; ++l) sink_.first(body * kV + l, row + l, one);
    sink_.first(body * kV + 3, row, Eigen::Matrix<T, F::m, 3>(x.transpose()));
  }
  template <bool has_r>
  void gradient_blocks(int row, int body, const Vec3<T>& g, const Ambient& e, bool transposed) const {
    if constexpr (has_r) {
      Eigen::Matrix<T, kV, 1> column;
      column.template head<3>() = g;
      column.template tail<F::m>() = c_.at[index(body)].W().transpose() * e;
      sink_.first(row, body * kV, Eigen::Matrix<T, 1, kV>(column.transpose()));
      if (transposed) sink_.first(body * kV, row, column);
    } else {
      const X column = c_.at[index(body)].W().transpose() * e;
      sink_.first(row, body * kV + 3, Eigen::Matrix<T, 1, F::m>(column.transpose()));
      if (transposed) sink_.first(body * kV + 3, row, column);
    }
  }

  const C& c_;
  Sink& sink_;
};

}  // namespace poinsot
