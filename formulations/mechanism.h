// A mechanism in formulation F on scalars T: residuals and matrices of M a + Gᵀλ = Q, Φ = 0 at one configuration.
//
// The central object of the program. The immutable part (Elements) is shared; the rest is one thread's workspace, sized
// once. The matrix is written by one traversal, write_matrix(), that either records the blocks' places or adds their
// values in the same order, so that pattern and values cannot disagree and nothing is looked up while assembling.
#pragma once

#include <algorithm>
#include <limits>

#include "formulations/forces.h"
#include "formulations/problem.h"
#include "formulations/rate_rows.h"

namespace poinsot {

template <class F, class T>
class Mechanism {
 public:
  using C = Configuration<F, T>;
  using Ambient = typename C::Ambient;
  using X = Eigen::Matrix<T, F::m, 1>;
  using XX = Eigen::Matrix<T, F::m, F::m>;
  using Gradient = typename Rows<F, T>::Gradient;
  static constexpr int kV = C::kVelocities, kQ = C::kCoordinates;

  explicit Mechanism(std::shared_ptr<const Elements> elements)
      : c(std::move(elements)),
        wrench_(c.at.size()),
        N_(c.at.size()),
        second_(*c.elements),
        needs_s_dot_(!c.elements->pfaffian.empty() || damped(*c.elements)) {}

  int nb() const { return c.elements->nb; }
  int nq() const { return kQ * nb(); }
  int nv() const { return kV * nb(); }
  int nc() const { return c.elements->rows + (F::normalized ? nb() : 0); }

  void set_position(const T& t, const T* q) { c.set_position(t, q); }
  void set_velocity(const T* v) {
    c.set_velocity(v);
    if (needs_s_dot_) c.compute_s_dot();
  }

  static void retract(const T* q, const T* dq, T* out, int bodies) {
    for (int b = 0; b < bodies; ++b) {
      for (int k = 0; k < 3; ++k) out[b * kQ + k] = q[b * kQ + k] + dq[b * kV + k];
      F::retract(q + b * kQ + 3, dq + b * kV + 3, out + b * kQ + 3);
    }
  }

  // Φ/position, and (Ψv − f)/velocity where `velocity` is not 0.
  void constraint_residual(const T& position, const T& velocity, T* out) const {
    const T by = T(1) / position;
    Rows<F, T>::holonomic(c, [&](const Gradient& g, auto, const T& Phi) { out[g.row] = by * Phi; });
    if (velocity == T(0)) {
      for (const PfaffianRow& k : c.elements->pfaffian) out[k.row] = T(0);
    } else {
      Rows<F, T>::velocity(c, [&](const Gradient& g, auto, const T& psi) { out[g.row] = psi / velocity; });
    }
    normalization_residual(by, out);
  }

  void velocity_residual(T* out) const {
    Rows<F, T>::nu(c, out);
    const auto times_v = [&](const Gradient& g, auto has_r, const T&) {
      T sum = T(0);
      if (g.i != kGround) sum += g.ei.dot(c.ambient_rate(g.i));
      if (g.j != kGround) sum += g.ej.dot(c.ambient_rate(g.j));
      if constexpr (has_r) sum += g.g.dot(c.rd(g.j) - c.rd(g.i));
      out[g.row] = sum - out[g.row];
    };
    Rows<F, T>::holonomic(c, times_v);
    Rows<F, T>::velocity(c, times_v);
    if constexpr (F::normalized) {
      for (int b = 0; b < nb(); ++b) out[c.elements->rows + b] = p(b).dot(coordinates(c.xd(c.v, b)));
    }
  }

  void nu(T* out) const {
    Rows<F, T>::nu(c, out);
    if constexpr (F::normalized) std::fill_n(out + c.elements->rows, nb(), T(0));
  }

  void gamma(T* out) {
    c.compute_s_dot();
    for (int b = 0; b < nb(); ++b) N_[index(b)] = F::A_ddot0(c.at[index(b)], c.rate[index(b)], c.xd(c.v, b));
    Rows<F, T>::gamma(c, N_, out);
    if constexpr (F::normalized) {
      for (int b = 0; b < nb(); ++b) out[c.elements->rows + b] = -coordinates(c.xd(c.v, b)).squaredNorm();
    }
  }

  // M v
  void momentum(const T* v_in, T* out) const {
    for (int b = 0; b < nb(); ++b) {
      Eigen::Map<Vec3<T>>(out + b * kV) = mass(b) * Eigen::Map<const Vec3<T>>(v_in + b * kV);
      Eigen::Map<X>(out + b * kV + 3) = F::mass(c.at[index(b)], J(b)) * coordinates(v_in + b * kV + 3);
    }
  }

  // M a + Gᵀλ − Q, and in the same pass over the rows the step's constraint residual into `rows` (may be null).
  void residual(const T* a, const T* lambda, T* out, const StepScale* scale, T* rows) {
    for (auto& w : wrench_) w = Wrench<F, T>();
    const T by = scale ? T(1.0 / scale->position) : T(0);
    Rows<F, T>::scalar(c, [&](const Gradient& g, auto has_r, const T& Phi) {
      react<decltype(has_r)::value>(g, lambda[g.row]);
      if (rows) rows[g.row] = by * Phi;
    });
    for (const CoincidenceRows& k : c.elements->coincidences) {
      const Vec3<T> force = Eigen::Map<const Vec3<T>>(lambda + k.row);
      if (k.i != kGround) {
        wrench_[index(k.i)].f -= force;
        wrench_[index(k.i)].e -= C::Et_times(c.s[index(k.p)], force);
      }
      if (k.j != kGround) {
        wrench_[index(k.j)].f += force;
        wrench_[index(k.j)].e += C::Et_times(c.s[index(k.q)], force);
      }
      if (rows) Eigen::Map<Vec3<T>>{rows + k.row} = by * c.span(k.i, k.j, k.p, k.q);
    }
    Rows<F, T>::velocity(c, [&](const Gradient& g, auto has_r, const T& psi) {
      react<decltype(has_r)::value>(g, lambda[g.row]);
      if (rows) rows[g.row] = psi / T(scale->velocity);
    });
    if (rows) normalization_residual(by, rows);
    if (c.elements->has_forces()) Forces<F, T>::residual(c, wrench_);

    const Vec3<T> gravity = c.elements->model->gravity.template cast<T>();
    for (int b = 0; b < nb(); ++b) {
      const auto& at = c.at[index(b)];
      const T* xd = c.xd(c.v, b);
      const T* ab = a + b * kV;
      Eigen::Map<Vec3<T>>(out + b * kV) = mass(b) * (Eigen::Map<const Vec3<T>>(ab) - gravity) + wrench_[index(b)].f;
      X x = at.W().transpose() * wrench_[index(b)].e;
      x += F::inertia_residual(at, c.rate[index(b)], xd, ab + 3, J(b));
      if constexpr (F::normalized) x += lambda[c.elements->rows + b] * at.p;
      Eigen::Map<X>(out + b * kV + 3) = x;
    }
  }

  // Gᵀλ
  void constraint_forces(const T* lambda, T* out) {
    for (auto& w : wrench_) w = Wrench<F, T>();
    const auto add = [&](const Gradient& g, auto has_r, const T&) { react<decltype(has_r)::value>(g, lambda[g.row]); };
    Rows<F, T>::holonomic(c, add);
    Rows<F, T>::velocity(c, add);
    for (int b = 0; b < nb(); ++b) {
      Eigen::Map<Vec3<T>>(out + b * kV) = wrench_[index(b)].f;
      X x = c.at[index(b)].W().transpose() * wrench_[index(b)].e;
      if constexpr (F::normalized) x += lambda[c.elements->rows + b] * p(b);
      Eigen::Map<X>(out + b * kV + 3) = x;
    }
  }

  // See Problem::assemble. The sink takes block(row, col, matrix) calls; an empty dq (null) means T = I.
  template <class Sink>
  void write_matrix(MatrixKind kind, const StepScale& scale, const T* dq, const T* a, const T* lambda, Sink&& sink) {
    if (kind == MatrixKind::kinematic) return gradients(sink, 0, false);
    if (kind == MatrixKind::rates) return rates(sink);
    const bool newton = kind == MatrixKind::simplified || kind == MatrixKind::exact;
    const bool exact = kind == MatrixKind::exact;
    tangents(dq);
    if (exact) {
      second_.clear();
      Rows<F, T>::second_variation(c, lambda, second_);
    }
    const T ca = T(scale.acceleration), cv = T(scale.velocity), cq = T(scale.position);
    for (int b = 0; b < nb(); ++b) body_blocks(b, kind, ca, cv, cq, a, lambda, sink);
    if (exact) {
      for (int k = 0; k < static_cast<int>(c.elements->pairs.size()); ++k) pair_blocks(k, cq, sink);
    }
    if (newton && c.elements->has_forces()) {
      ForceSink<Sink> blocks{sink};
      Forces<F, T>::matrix(c, scale, T_inverse_, blocks);
    }
    gradients(sink, nv(), true);
    if (newton) velocity_rows(scale, sink);
  }

  // z ← T(dq)⁻¹ z
  static void lower(const T* dq, T* z, int bodies) {
    if constexpr (F::lie_group) {
      for (int b = 0; b < bodies; ++b) {
        Eigen::Map<X> x(z + b * kV + 3);
        x = right_jacobian_inverse_times<T>(Eigen::Map<const X>(dq + b * kV + 3), x);
      }
    }
  }

  // Force and moment about its centre of mass on body j, global, by rows [first, first + count).
  void reaction(int first, int count, const T* lambda, Vec3<T>& force, Vec3<T>& moment) const {
    force.setZero();
    moment.setZero();
    const auto add = [&](const Gradient& g, auto has_r, const T&) {
      if (g.row < first || g.row >= first + count) return;
      if constexpr (has_r) force -= lambda[g.row] * g.g;
      moment -= lambda[g.row] * g.ej.template head<3>();
    };
    Rows<F, T>::holonomic(c, add);
    Rows<F, T>::velocity(c, add);
  }

  T energy() const {
    T sum = Forces<F, T>::energy(c);
    const Vec3<T> gravity = c.elements->model->gravity.template cast<T>();
    for (int b = 0; b < nb(); ++b) {
      const Vec3<T>& w = c.rate[index(b)].w;
      sum += T(0.5) * mass(b) * c.rd(b).squaredNorm() - mass(b) * gravity.dot(c.r(b)) + T(0.5) * w.dot(J(b) * w);
    }
    return sum;
  }

  C c;

 private:
  static std::size_t index(int k) { return static_cast<std::size_t>(k); }
  static Eigen::Map<const X> coordinates(const T* x) { return Eigen::Map<const X>(x); }
  const Vec4<T>& p(int b) const { return c.at[index(b)].p; }
  T mass(int b) const { return T(c.elements->inertia[index(b)].mass); }
  decltype(auto) J(int b) const {
    const Matrix3& J_bar = c.elements->inertia[index(b)].J;
    if constexpr (std::is_same_v<T, double>) {
      return (J_bar);
    } else {
      return Mat3<T>(J_bar.template cast<T>());
    }
  }
  static bool damped(const Elements& e) {
    return std::any_of(e.springs.begin(), e.springs.end(), [](const SpringElement& k) { return k.damping != 0; }) ||
           std::any_of(e.torsions.begin(), e.torsions.end(), [](const TorsionRow& k) { return k.damping != 0; });
  }

  // Adds a row's force l on its two bodies.
  template <bool has_r>
  void react(const Gradient& g, const T& l) {
    if (g.i != kGround) {
      wrench_[index(g.i)].e += l * g.ei;
      if constexpr (has_r) wrench_[index(g.i)].f -= l * g.g;
    }
    if (g.j != kGround) {
      wrench_[index(g.j)].e += l * g.ej;
      if constexpr (has_r) wrench_[index(g.j)].f += l * g.g;
    }
  }

  void normalization_residual(const T& by, T* out) const {
    if constexpr (F::normalized) {
      for (int b = 0; b < nb(); ++b) out[c.elements->rows + b] = by * T(0.5) * (p(b).squaredNorm() - T(1));
    }
  }

  void tangents(const T* dq) {
    if constexpr (F::lie_group) {
      T_inverse_.clear();
      if (!dq) return;
      for (int b = 0; b < nb(); ++b) {
        T_inverse_.push_back(right_jacobian_inverse<T>(Eigen::Map<const X>(dq + b * kV + 3)));
      }
    }
  }

  template <class Sink>
  void body_blocks(int b, MatrixKind kind, const T& ca, const T& cv, const T& cq, const T* a, const T* lambda,
                   Sink&& sink) {
    const bool newton = kind == MatrixKind::simplified || kind == MatrixKind::exact;
    const bool exact = kind == MatrixKind::exact;
    const Mat3<T>& J = this->J(b);
    const auto& at = c.at[index(b)];
    const auto& rate = c.rate[index(b)];
    const T* xd = c.xd(c.v, b);
    const int r = b * kV, x = r + 3;

    const Eigen::Matrix<T, 1, 1> m(ca * mass(b));
    for (int k = 0; k < 3; ++k) sink.block(r + k, r + k, m);

    XX xx = ca * F::mass(at, J);
    if (exact || (newton && F::simplified_keeps_rate_term)) xx += cv * F::inertia_rate_variation(at, rate, xd, J);
    if constexpr (F::lie_group) {
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
        if (c.elements->body_rr[index(b)]) sink.block(r, r, Mat3<T>(cq * own.rr));
        sink.block(r, x, Eigen::Matrix<T, 3, F::m>(cq * own.rx * W));
        sink.block(x, r, Eigen::Matrix<T, F::m, 3>(cq * (own.xr_transposed * W).transpose()));
      }
      xx += cq * K;
    }
    sink.block(x, x, xx);
    if constexpr (F::normalized) {
      const int row = nv() + c.elements->rows + b;
      sink.block(row, x, Eigen::Matrix<T, 1, F::m>(at.p.transpose()));
      sink.block(x, row, X(at.p));
    }
  }

  template <class Sink>
  void pair_blocks(int k, const T& cq, Sink&& sink) {
    const Pair& pair = c.elements->pairs[index(k)];
    const auto& xx = second_.pair(k);
    const auto &Wi = c.at[index(pair.i)].W(), &Wj = c.at[index(pair.j)].W();
    const int ri = pair.i * kV, xi = ri + 3, rj = pair.j * kV, xj = rj + 3;
    sink.block(xi, xj, XX(cq * (Wi.transpose() * xx.xx_ij * Wj)));
    sink.block(xj, xi, XX(cq * (Wj.transpose() * xx.xx_ji * Wi)));
    if (pair.with_r < 0) return;
    const auto& sum = second_.pair_with_r(k);
    using RX = Eigen::Matrix<T, 3, F::m>;
    using XR = Eigen::Matrix<T, F::m, 3>;
    if (pair.rx) {
      sink.block(ri, xj, RX(cq * sum.rx_ij * Wj));
      sink.block(xj, ri, XR(cq * (sum.xr_ji_transposed * Wj).transpose()));
    }
    if (pair.xr) {
      sink.block(rj, xi, RX(cq * sum.rx_ji * Wi));
      sink.block(xi, rj, XR(cq * (sum.xr_ij_transposed * Wi).transpose()));
    }
    if (pair.rr) {
      const Eigen::Matrix<T, 1, 1> rr(cq * sum.rr);
      for (int l = 0; l < 3; ++l) {
        sink.block(ri + l, rj + l, rr);
        sink.block(rj + l, ri + l, rr);
      }
    }
  }

  // G at rows `first_row` on, and Gᵀ beside it.
  template <class Sink>
  void gradients(Sink&& sink, int first_row, bool transposed) {
    const auto write = [&](const Gradient& g, auto has_r, const T&) {
      if (g.i != kGround) gradient_blocks<decltype(has_r)::value>(first_row + g.row, g.i, -g.g, g.ei, transposed, sink);
      if (g.j != kGround) gradient_blocks<decltype(has_r)::value>(first_row + g.row, g.j, g.g, g.ej, transposed, sink);
    };
    Rows<F, T>::scalar(c, write);
    for (const CoincidenceRows& k : c.elements->coincidences) {
      if (k.i != kGround) coincidence_blocks(first_row + k.row, k.i, k.p, T(-1), transposed, sink);
      if (k.j != kGround) coincidence_blocks(first_row + k.row, k.j, k.q, T(1), transposed, sink);
    }
    Rows<F, T>::velocity(c, write);
    if constexpr (F::normalized) {
      if (transposed) return;  // beside the inertia there
      for (int b = 0; b < nb(); ++b) {
        sink.block(c.elements->rows + b, b * kV + 3, Eigen::Matrix<T, 1, F::m>(p(b).transpose()));
      }
    }
  }
  // ± [I, E(s) Ŵ]
  template <class Sink>
  void coincidence_blocks(int row, int body, int point, const T& sign, bool transposed, Sink&& sink) {
    using GX = Eigen::Matrix<T, 3, F::m>;
    const Eigen::Matrix<T, 1, 1> one(sign);
    const GX x = sign * C::E_times(c.s[index(point)], c.at[index(body)].W());
    for (int l = 0; l < 3; ++l) sink.block(row + l, body * kV + l, one);
    sink.block(row, body * kV + 3, x);
    if (!transposed) return;
    for (int l = 0; l < 3; ++l) sink.block(body * kV + l, row + l, one);
    sink.block(body * kV + 3, row, Eigen::Matrix<T, F::m, 3>(x.transpose()));
  }
  template <bool has_r, class Sink>
  void gradient_blocks(int row, int body, const Vec3<T>& g, const Ambient& e, bool transposed, Sink&& sink) {
    if constexpr (has_r) {
      Eigen::Matrix<T, kV, 1> column;
      column.template head<3>() = g;
      column.template tail<F::m>() = c.at[index(body)].W().transpose() * e;
      sink.block(row, body * kV, Eigen::Matrix<T, 1, kV>(column.transpose()));
      if (transposed) sink.block(body * kV, row, column);
    } else {
      const X column = c.at[index(body)].W().transpose() * e;
      sink.block(row, body * kV + 3, Eigen::Matrix<T, 1, F::m>(column.transpose()));
      if (transposed) sink.block(body * kV + 3, row, column);
    }
  }

  // A velocity row of the step is (Ψv − f)/velocity. Its matrix row Ψ T⁻¹ + position/velocity ∂(Ψv)/∂q differs from the
  // gradient Ψ written with the others by what is added here.
  template <class Sink>
  void velocity_rows(const StepScale& scale, Sink&& sink) {
    const T by = T(scale.position / scale.velocity);
    const auto write = [&](int row, int body, const X& variation, const Vec3<T>& point, const Vec3<T>& direction) {
      if (body == kGround) return;
      X x = by * variation;
      if constexpr (F::lie_group) {
        if (!T_inverse_.empty()) {
          const X psi = c.at[index(body)].W().transpose() * C::Et_times(point, direction);
          x += T_inverse_[index(body)].transpose() * psi - psi;
        }
      }
      sink.block(nv() + row, body * kV + 3, Eigen::Matrix<T, 1, F::m>(x.transpose()));
    };
    auto k = c.elements->pfaffian.begin();
    RateRows<F, T>::velocity(c, [&](const auto& variation, auto) {
      const Vec3<T>& a = c.s[index(k->a)];
      write(k->row, k->i, variation.xi, c.s[index(k->p)], -a);
      write(k->row, k->j, variation.xj, c.s[index(k->q)], a);
      ++k;
    });
  }

  // ∂(G v − ν)/∂q
  template <class Sink>
  void rates(Sink&& sink) {
    c.compute_s_dot();
    const auto write = [&](const auto& variation, auto has_r) {
      const auto on = [&](int body, const Vec3<T>& g, const X& x) {
        if (body == kGround) return;
        if constexpr (has_r) sink.block(variation.row, body * kV, Eigen::Matrix<T, 1, 3>(g.transpose()));
        sink.block(variation.row, body * kV + 3, Eigen::Matrix<T, 1, F::m>(x.transpose()));
      };
      on(variation.i, -variation.g, variation.xi);
      on(variation.j, variation.g, variation.xj);
    };
    RateRows<F, T>::holonomic(c, write);
    RateRows<F, T>::velocity(c, write);
    if constexpr (F::normalized) {
      for (int b = 0; b < nb(); ++b) {
        sink.block(c.elements->rows + b, b * kV + 3, Eigen::Matrix<T, 1, F::m>(coordinates(c.xd(c.v, b)).transpose()));
      }
    }
  }

  template <class Sink>
  struct ForceSink {
    Sink& sink;
    template <class M>
    void body_block(int row_body, int col_body, const M& m) {
      sink.block(row_body * kV, col_body * kV, m);
    }
    template <class M>
    void orientation_block(int row_body, int col_body, const M& m) {
      sink.block(row_body * kV + 3, col_body * kV + 3, m);
    }
  };

  std::vector<Wrench<F, T>> wrench_;
  std::vector<Mat3<T>> N_;
  std::vector<XX> T_inverse_;
  SecondVariation<F, T> second_;
  bool needs_s_dot_;
};

}  // namespace poinsot
