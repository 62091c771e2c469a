// A mechanism in formulation F on scalars T: residuals of M a + Gᵀλ = Q, Φ = 0, G v = ν, G a = γ at one configuration.
//
// The central object of the program; its matrices are written by formulations/mechanism_matrix.h. The immutable part
// (Elements) is shared; the rest is one thread's workspace, sized once.
#pragma once

#include <algorithm>

#include "core/index.h"
#include "formulations/forces.h"
#include "formulations/problem.h"
#include "formulations/rows.h"

namespace poinsot {

template <Formulation F, class T>
class Mechanism {
 public:
  using C = Configuration<F, T>;
  using Ambient = typename C::Ambient;
  using X = Eigen::Matrix<T, F::m, 1>;
  using Gradient = typename Rows<F, T>::Gradient;
  static constexpr int kV = C::kVelocities, kQ = C::kCoordinates;

  explicit Mechanism(std::shared_ptr<const Elements> elements)
      : c(std::move(elements)), wrench_(c.at.size()), N_(c.at.size()), needs_s_dot_(damped_torsion(*c.elements)) {}

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
    Rows<F, T>::scalar(c, [&](const Gradient& g, auto, const T& Phi) { out[g.row] = by * Phi; });
    for (const CoincidenceRows& k : c.elements->coincidences) coincidence_residual(k, by, out);
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
      for (int b = 0; b < nb(); ++b) out[c.elements->rows + b] = c.p(b).dot(coordinates(c.xd(b)));
    }
  }

  void nu(T* out) const {
    Rows<F, T>::nu(c, out);
    if constexpr (F::normalized) std::fill_n(out + c.elements->rows, nb(), T(0));
  }

  void gamma(T* out) {
    c.compute_s_dot();
    for (int b = 0; b < nb(); ++b) N_[index(b)] = F::A_ddot0(c.at[index(b)], c.rate[index(b)], c.xd(b));
    Rows<F, T>::gamma(c, N_, out);
    if constexpr (F::normalized) {
      for (int b = 0; b < nb(); ++b) out[c.elements->rows + b] = -coordinates(c.xd(b)).squaredNorm();
    }
  }

  // M v
  void momentum(const T* v_in, T* out) const {
    for (int b = 0; b < nb(); ++b) {
      Eigen::Map<Vec3<T>>(out + b * kV) = c.mass(b) * Eigen::Map<const Vec3<T>>(v_in + b * kV);
      Eigen::Map<X>(out + b * kV + 3) = F::mass(c.at[index(b)], c.J(b)) * coordinates(v_in + b * kV + 3);
    }
  }

  // M a + Gᵀλ − Q, and in the same pass over the rows the step's constraint residual into `rows`. Without λ and `rows`
  // (both may be null) no row is looked at.
  void residual(const T* a, const T* lambda, T* out, const StepScale* scale, T* rows) {
    for (auto& w : wrench_) w = Wrench<F, T>();
    if (lambda) reactions(lambda, scale, rows);
    if (c.elements->has_forces()) Forces<F, T>::residual(c, wrench_);

    const Vec3<T> gravity = c.elements->model->gravity.template cast<T>();
    for (int b = 0; b < nb(); ++b) {
      const auto& at = c.at[index(b)];
      const T* xd = c.xd(b);
      const T* ab = a + b * kV;
      Eigen::Map<Vec3<T>>(out + b * kV) = c.mass(b) * (Eigen::Map<const Vec3<T>>(ab) - gravity) + wrench_[index(b)].f;
      X x = at.W().transpose() * wrench_[index(b)].e;
      x += F::inertia_residual(at, c.rate[index(b)], xd, ab + 3, c.J(b));
      if constexpr (F::normalized) {
        if (lambda) x += lambda[c.elements->rows + b] * at.p;
      }
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
      if constexpr (F::normalized) x += lambda[c.elements->rows + b] * c.p(b);
      Eigen::Map<X>(out + b * kV + 3) = x;
    }
  }

  // z ← T(dq)⁻¹ z
  static void lower(const T* dq, T* z, int bodies) {
    if constexpr (F::space == CoordinateSpace::lie_group) {
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
    const RowRange near{first - 2, first + count};  // the three of a coincidence may be of as many groups
    Rows<F, T>::holonomic(c, add, near);
    Rows<F, T>::velocity(c, add, near);
  }

  T energy() const {
    T sum = Forces<F, T>::energy(c);
    const Vec3<T> gravity = c.elements->model->gravity.template cast<T>();
    for (int b = 0; b < nb(); ++b) {
      const Vec3<T>& w = c.rate[index(b)].w;
      sum += T(0.5) * c.mass(b) * c.rd(b).squaredNorm() - c.mass(b) * gravity.dot(c.r(b)) + T(0.5) * w.dot(c.J(b) * w);
    }
    return sum;
  }

  C c;

 private:
  static Eigen::Map<const X> coordinates(const T* x) { return Eigen::Map<const X>(x); }
  static bool damped_torsion(const Elements& e) {
    return std::any_of(e.torsions.begin(), e.torsions.end(), [](const TorsionSpringElement& k) { return k.damped; });
  }

  // Gᵀλ into the wrenches, and the step's constraint residual into `rows`.
  void reactions(const T* lambda, const StepScale* scale, T* rows) {
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
      if (rows) coincidence_residual(k, by, rows);
    }
    Rows<F, T>::velocity(c, [&](const Gradient& g, auto has_r, const T& psi) {
      react<decltype(has_r)::value>(g, lambda[g.row]);
      if (rows) rows[g.row] = psi / T(scale->velocity);
    });
    if (rows) normalization_residual(by, rows);
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

  void coincidence_residual(const CoincidenceRows& k, const T& by, T* out) const {
    Eigen::Map<Vec3<T>>{out + k.row} = by * c.span(k.i, k.j, k.p, k.q);
  }
  void normalization_residual(const T& by, T* out) const {
    if constexpr (F::normalized) {
      for (int b = 0; b < nb(); ++b) out[c.elements->rows + b] = by * T(0.5) * (c.p(b).squaredNorm() - T(1));
    }
  }

  std::vector<Wrench<F, T>> wrench_;
  std::vector<Mat3<T>> N_;
  bool needs_s_dot_;
};

}  // namespace poinsot
