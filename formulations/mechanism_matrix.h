// The matrices of a mechanism in formulation F on scalars T; what they are says formulations/problem.h.
//
// One traversal, write(), either records the blocks' places or writes their values in the same order, so that pattern
// and values cannot disagree and nothing is looked up while assembling. The Newton matrix over the accelerations is
//   ca M + (cv ∂/∂v) T⁻¹ + cq ∂/∂q of M a + Gᵀλ − Q, bordered by G and Gᵀ,
// where T = T(dq) is the tangent operator of rA's step, the identity elsewhere.
#pragma once

#include <vector>

#include "core/index.h"
#include "formulations/forces.h"
#include "formulations/problem.h"
#include "formulations/row_blocks.h"
#include "formulations/second_variation.h"

namespace poinsot {

template <Formulation F, class T>
class MechanismMatrix {
 public:
  using C = Configuration<F, T>;
  using X = Eigen::Matrix<T, F::m, 1>;
  using XX = Eigen::Matrix<T, F::m, F::m>;
  static constexpr int kV = C::kVelocities;

  explicit MechanismMatrix(const Elements& elements) : second_(elements) {}

  // Whether there are places that nothing but add() writes to, which are to hold zeros before: those of forces, and of
  // pairs of bodies, which rows may name in either order.
  static bool adds_only(const Elements& elements, MatrixKind kind) {
    const bool exact = kind == MatrixKind::exact;
    return (exact && !elements.pairs.empty()) || ((exact || kind == MatrixKind::simplified) && elements.has_forces());
  }
  // See Problem::assemble and formulations/blocks.h; an empty dq (null) means T = I. Never inlined: it is called for
  // places and for values, and would be compiled for each.
  template <class Sink>
  [[gnu::noinline]] void write(C& c, MatrixKind kind, const StepScale& scale, const T* dq, const T* a, const T* lambda,
                               Sink& sink) {
    const RowBlocks<F, T, Sink> rows(c, sink);
    if (kind == MatrixKind::kinematic) return rows.gradients(0, false);
    if (kind == MatrixKind::rates) {
      c.compute_s_dot();
      return rows.rates();
    }
    const bool newton = kind == MatrixKind::simplified || kind == MatrixKind::exact;
    const bool exact = kind == MatrixKind::exact;
    tangents(c.elements->nb, dq);
    if (exact) second_.compute(c, lambda);
    const T ca = T(scale.acceleration), cv = T(scale.velocity), cq = T(scale.position);
    for (int b = 0; b < c.elements->nb; ++b) body_blocks(c, b, kind, ca, cv, cq, a, lambda, sink);
    if (exact) {
      for (int k = 0; k < static_cast<int>(c.elements->pairs.size()); ++k) pair_blocks(c, k, cq, sink);
    }
    if (newton && c.elements->has_forces()) {
      ForceSink<Sink> blocks{sink};
      Forces<F, T>::matrix(c, scale, T_inverse_, blocks);
    }
    const int nv = kV * c.elements->nb;
    rows.gradients(nv, true);
    if (newton) rows.velocity_rows(scale, nv, T_inverse_);
  }

 private:
  void tangents(int bodies, const T* dq) {
    if constexpr (F::space == CoordinateSpace::lie_group) {
      T_inverse_.clear();
      if (!dq) return;
      for (int b = 0; b < bodies; ++b) {
        T_inverse_.push_back(right_jacobian_inverse<T>(Eigen::Map<const X>(dq + b * kV + 3)));
      }
    }
  }

  template <class Sink>
  void body_blocks(const C& c, int b, MatrixKind kind, const T& ca, const T& cv, const T& cq, const T* a,
                   const T* lambda, Sink& sink) {
    const bool newton = kind == MatrixKind::simplified || kind == MatrixKind::exact;
    const bool exact = kind == MatrixKind::exact;
    const Mat3<T>& J = c.J(b);
    const auto& at = c.at[index(b)];
    const auto& rate = c.rate[index(b)];
    const T* xd = c.xd(b);
    const int r = b * kV, x = r + 3;

    const Eigen::Matrix<T, 1, 1> m(ca * c.mass(b));
    if (exact && c.elements->body_rr[index(b)]) {
      sink.first(r, r, Mat3<T>(cq * second_.body(b).rr));
      for (int k = 0; k < 3; ++k) sink.add(r + k, r + k, m);
    } else {
      for (int k = 0; k < 3; ++k) sink.first(r + k, r + k, m);
    }

    XX xx = ca * F::mass(at, J);
    if (exact || (newton && F::simplified_keeps_rate_term)) xx += cv * F::inertia_rate_variation(at, rate, xd, J);
    if constexpr (F::space == CoordinateSpace::lie_group) {
      if (!T_inverse_.empty()) xx *= T_inverse_[index(b)];
    }
    if (exact) {
      XX K = F::H(at, second_.S[index(b)]);
      if constexpr (F::inertia_depends_on_position) {
        K += F::inertia_position_variation(at, rate, xd, a + b * kV + 3, J);
      }
      if constexpr (F::normalized) K.diagonal().array() += lambda[c.elements->rows + b];
      if (c.elements->body_rx[index(b)]) {
        const auto& own = second_.body(b);
        const auto& W = at.W();
        K += W.transpose() * own.xx * W;
        if (!c.elements->pfaffian.empty()) K += F::torque_variation(at, own.moment);
        sink.first(r, x, Eigen::Matrix<T, 3, F::m>(cq * own.rx * W));
        sink.first(x, r, Eigen::Matrix<T, F::m, 3>(cq * (own.xr_transposed * W).transpose()));
      }
      xx += cq * K;
    }
    sink.first(x, x, xx);
    if constexpr (F::normalized) {
      const int row = kV * c.elements->nb + c.elements->rows + b;
      sink.first(row, x, Eigen::Matrix<T, 1, F::m>(at.p.transpose()));
      sink.first(x, row, X(at.p));
    }
  }

  template <class Sink>
  void pair_blocks(const C& c, int k, const T& cq, Sink& sink) {
    const Pair& pair = c.elements->pairs[index(k)];
    const auto& xx = second_.pair(k);
    const auto &Wi = c.at[index(pair.i)].W(), &Wj = c.at[index(pair.j)].W();
    const int ri = pair.i * kV, xi = ri + 3, rj = pair.j * kV, xj = rj + 3;
    sink.add(xi, xj, XX(cq * (Wi.transpose() * xx.xx_ij * Wj)));
    sink.add(xj, xi, XX(cq * (Wj.transpose() * xx.xx_ji * Wi)));
    if (pair.with_r < 0) return;
    const auto& sum = second_.pair_with_r(k);
    using RX = Eigen::Matrix<T, 3, F::m>;
    using XR = Eigen::Matrix<T, F::m, 3>;
    if (pair.rx) {
      sink.add(ri, xj, RX(cq * sum.rx_ij * Wj));
      sink.add(xj, ri, XR(cq * (sum.xr_ji_transposed * Wj).transpose()));
    }
    if (pair.xr) {
      sink.add(rj, xi, RX(cq * sum.rx_ji * Wi));
      sink.add(xi, rj, XR(cq * (sum.xr_ij_transposed * Wi).transpose()));
    }
    if (pair.rr) {
      const Eigen::Matrix<T, 1, 1> rr(cq * sum.rr);
      for (int l = 0; l < 3; ++l) {
        sink.add(ri + l, rj + l, rr);
        sink.add(rj + l, ri + l, rr);
      }
    }
  }

  template <class Sink>
  struct ForceSink {
    Sink& sink;
    bool places_only = sink.places_only();  // no values: functions of the program are not asked for any
    template <class M>
    void body_block(int row_body, int col_body, const M& m) {
      sink.add(row_body * kV, col_body * kV, m);
    }
    template <class M>
    void orientation_block(int row_body, int col_body, const M& m) {
      sink.add(row_body * kV + 3, col_body * kV + 3, m);
    }
  };

  std::vector<XX> T_inverse_;
  SecondVariation<F, T> second_;
};

}  // namespace poinsot
