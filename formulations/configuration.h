// Where a mechanism stands: orientations, attached vectors and right-hand sides at one (t, q, v), in formulation F.
//
// Vectors are laid out as formulations/problem.h says. Everything is computed once per configuration and read by the
// row and force kernels; a scalar type T other than double serves the derivative tests and extended-precision
// references. Time is a T as well: a dual time differentiates the right-hand sides with everything else.
#pragma once

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <limits>
#include <memory>
#include <type_traits>
#include <vector>

#include "core/so3.h"
#include "formulations/callback_loads.h"
#include "formulations/elements.h"
#include "formulations/formulation.h"
#include "formulations/law_potential.h"

namespace poinsot {

// f, ḟ, f̈ at time t as numbers T. The third derivative is not known: f̈ of a dual time is a constant.
template <class T>
Jet2<T> lift(const Jet2<double>& f, const T&) {
  return {T(f.f), T(f.fd), T(f.fdd)};
}
template <class T>
Jet2<Dual<T>> lift(const Jet2<double>& f, const Dual<T>& t) {
  return {{T(f.f), T(f.fd) * t.d}, {T(f.fd), T(f.fdd) * t.d}, T(f.fdd)};
}

template <Formulation F, class T>
class Configuration {
 public:
  using Ambient = Eigen::Matrix<T, F::ambient, 1>;
  static constexpr int kVelocities = 3 + F::m;        // numbers per body in v, a and δq
  static constexpr int kCoordinates = 3 + F::stored;  // numbers per body in q

  explicit Configuration(std::shared_ptr<const Elements> of)
      : elements(std::move(of)),
        centre(static_cast<std::size_t>(elements->nb)),
        v(centre.size() * kVelocities),
        at(centre.size()),
        rate(at.size()),
        s(elements->markers.size()),
        s_dot(s.size(), Vec3<T>::Zero()),
        f(elements->right_sides.size()),
        dp1(elements->dp1),
        twist(elements->torsions.size(), 0.0),
        followed(elements->followed.size(), 0.0),
        alternate_stood_in(elements->alternates.size(), 2),
        callbacks(elements->model->callbacks.begin(), elements->model->callbacks.end()) {
    for (const SpringElement& k : elements->springs) stored.emplace_back(k.law);
    for (const TorsionSpringElement& k : elements->torsions) stored.emplace_back(k.law);
    for (std::size_t k = static_cast<std::size_t>(elements->ground_markers); k < s.size(); ++k) {
      s[k] = elements->markers[k].s_bar.template cast<T>();
    }
    for (std::size_t k = 0; k < f.size(); ++k) {
      const RightSide& side = elements->right_sides[k];
      if (side.f.is_constant()) {
        f[k] = evaluate(side, T(0));
      } else {
        moving.push_back(static_cast<int>(k));
      }
    }
  }

  void set_position(const T& t, const T* q) {
    if (!std::is_floating_point_v<T> || t != time) set_time(t);
    for (std::size_t b = 0; b < at.size(); ++b, q += kCoordinates) {
      centre[b] = Eigen::Map<const Vec3<T>>(q);
      F::position(q + 3, at[b]);
    }
    for (std::size_t k = 0; k < static_cast<std::size_t>(elements->ground_markers); ++k) {
      const Marker& marker = elements->markers[k];
      s[k] = at[static_cast<std::size_t>(marker.body)].A * marker.s_bar.template cast<T>();
    }
  }

  void set_velocity(const T* v_in) {
    std::copy_n(v_in, v.size(), v.begin());
    for (std::size_t b = 0; b < at.size(); ++b) F::velocity(at[b], xd(static_cast<int>(b)), rate[b]);
  }

  // Ŵ ẋ: global angular velocity, in rp also the stretch rate.
  Ambient ambient_rate(int body) const {
    const std::size_t b = static_cast<std::size_t>(body);
    Ambient z;
    z.template head<3>() = rate[b].wg;
    if constexpr (F::ambient == 4) {
      z[3] = at[b].W().row(3).dot(Eigen::Map<const Eigen::Matrix<T, F::m, 1>>(xd(body)));
    }
    return z;
  }

  // ṡ of every attached vector: for the damping of torsion springs and γ only, so not part of set_velocity.
  void compute_s_dot() {
    for (std::size_t k = 0; k < static_cast<std::size_t>(elements->ground_markers); ++k) {
      s_dot[k] = E_times(s[k], ambient_rate(elements->markers[k].body));
    }
  }

  Vec3<T> r(int body) const {
    return body == kGround ? Vec3<T>(Vec3<T>::Zero()) : centre[static_cast<std::size_t>(body)];
  }
  Vec3<T> rd(int body) const {
    return body == kGround ? Vec3<T>(Vec3<T>::Zero())
                           : Vec3<T>(Eigen::Map<const Vec3<T>>(v.data() + body * kVelocities));
  }
  const T* xd(int body) const { return v.data() + body * kVelocities + 3; }

  const Vec4<T>& p(int body) const { return at[static_cast<std::size_t>(body)].p; }  // in rp
  T mass(int body) const { return T(elements->inertia[static_cast<std::size_t>(body)].mass); }
  decltype(auto) J(int body) const {
    const Matrix3& J_bar = elements->inertia[static_cast<std::size_t>(body)].J;
    if constexpr (std::is_same_v<T, double>) {
      return (J_bar);
    } else {
      return Mat3<T>(J_bar.template cast<T>());
    }
  }
  Vec3<T> s_bar(int marker) const {
    return elements->markers[static_cast<std::size_t>(marker)].s_bar.template cast<T>();
  }

  // ∂ṡ/∂x
  Eigen::Matrix<T, 3, F::m> s_dot_variation(int body, int marker) const {
    const std::size_t b = static_cast<std::size_t>(body);
    return F::s_dot_variation(at[b], rate[b], xd(body), s_bar(marker));
  }
  // ∂(ω × s)/∂x and ∂(ω × s)/∂ẋ
  Eigen::Matrix<T, 3, F::m> turn_rate_variation(int body, int marker) const {
    const std::size_t b = static_cast<std::size_t>(body);
    const Vec3<T>& s_of = s[static_cast<std::size_t>(marker)];
    return -tilde<T>(s_of) * F::angular_velocity_variation(at[b], rate[b], xd(body)) +
           tilde<T>(rate[b].wg) * E_times(s_of, at[b].W());
  }
  Eigen::Matrix<T, 3, F::m> turn_rate_gradient(int body, int marker) const {
    return -tilde<T>(s[static_cast<std::size_t>(marker)]) *
           at[static_cast<std::size_t>(body)].W().template topRows<3>();
  }

  // d = r_j + s_q − r_i − s_p and its rate.
  Vec3<T> span(int i, int j, int p, int q_marker) const {
    return r(j) + s[static_cast<std::size_t>(q_marker)] - r(i) - s[static_cast<std::size_t>(p)];
  }
  Vec3<T> span_rate(int i, int j, int p, int q_marker) const {
    return rd(j) + s_dot[static_cast<std::size_t>(q_marker)] - rd(i) - s_dot[static_cast<std::size_t>(p)];
  }
  // What of ḋ bodies make that are rigid: in rp p·ṗ is not 0 within a step, and stretches besides.
  Vec3<T> rigid_span_rate(int i, int j, int p, int q_marker) const {
    return rd(j) + turn_rate(q_marker) - rd(i) - turn_rate(p);
  }
  Vec3<T> w(int body) const {  // global
    return body == kGround ? Vec3<T>(Vec3<T>::Zero()) : rate[static_cast<std::size_t>(body)].wg;
  }

  // E(s)ᵀ w = [s × w; s·w], E(s) z = z × s + stretch s; E(s) is 3 × ambient.
  static Ambient Et_times(const Vec3<T>& s_of, const Vec3<T>& w) {
    Ambient e;
    e.template head<3>() = s_of.cross(w);
    if constexpr (F::ambient == 4) e[3] = s_of.dot(w);
    return e;
  }
  // The same of w's moment alone.
  static Ambient moment(const Vec3<T>& s_of, const Vec3<T>& w) {
    Ambient e = Ambient::Zero();
    e.template head<3>() = s_of.cross(w);
    return e;
  }
  static Vec3<T> E_times(const Vec3<T>& s_of, const Ambient& z) {
    Vec3<T> u = z.template head<3>().cross(s_of);
    if constexpr (F::ambient == 4) u += z[3] * s_of;
    return u;
  }
  // E(s) of every column
  static Eigen::Matrix<T, 3, F::m> E_times(const Vec3<T>& s_of, const Eigen::Matrix<T, F::ambient, F::m>& z) {
    Eigen::Matrix<T, 3, F::m> u;
    for (int k = 0; k < F::m; ++k) u.col(k) = E_times(s_of, Ambient(z.col(k)));
    return u;
  }
  static Eigen::Matrix<T, 3, F::ambient> E(const Vec3<T>& s_of) {
    Eigen::Matrix<T, 3, F::ambient> e;
    e.template leftCols<3>() = -tilde<T>(s_of);
    if constexpr (F::ambient == 4) e.col(3) = s_of;
    return e;
  }
  // E(s)ᵀ E(z)
  static Eigen::Matrix<T, F::ambient, F::ambient> EtE(const Vec3<T>& s_of, const Vec3<T>& z) {
    Eigen::Matrix<T, F::ambient, F::ambient> p;
    const T dot = s_of.dot(z);
    p.template topLeftCorner<3, 3>() = -z * s_of.transpose();
    p(0, 0) += dot, p(1, 1) += dot, p(2, 2) += dot;
    if constexpr (F::ambient == 4) {
      const Vec3<T> cross = s_of.cross(z);
      p.template block<3, 1>(0, 3) = cross;
      p.template block<1, 3>(3, 0) = -cross.transpose();
      p(3, 3) = dot;
    }
    return p;
  }

  std::shared_ptr<const Elements> elements;
  T time = T(std::numeric_limits<double>::quiet_NaN());
  std::vector<Vec3<T>> centre;  // r of every body
  std::vector<T> v;             // all velocities; what is kept is kept here, and nothing refers to the caller's vectors
  std::vector<typename F::template Position<T>> at;
  std::vector<typename F::template Velocity<T>> rate;
  std::vector<Vec3<T>> s, s_dot;         // of every marker, global
  std::vector<Jet2<T>> f;                // of every right-hand side
  std::vector<DP1Row> dp1;               // with the alternates that stand in at this time
  std::vector<double> twist;             // angle of every torsion spring at the last accepted step, rad
  std::vector<double> followed;          // the same of angles that are followed
  std::vector<char> alternate_stood_in;  // at the last accepted step, by Elements::alternates; 2: there was none
  mutable std::vector<CallbackLoads> callbacks;  // room for what they are given and give
  mutable std::vector<LawPotential> stored;      // of springs, then of torsion springs

 private:
  Vec3<T> turn_rate(int marker) const {
    return w(elements->markers[static_cast<std::size_t>(marker)].body).cross(s[static_cast<std::size_t>(marker)]);
  }

  static Jet2<T> evaluate(const RightSide& side, const T& t) {
    const Jet2<double> jet = side.f.at(plain(t));
    if (!side.squared) return lift(jet, t);
    constexpr double nan = std::numeric_limits<double>::quiet_NaN();
    if (!(jet.f > 0)) return lift(Jet2<double>{nan, nan, nan}, t);  // no length; its square would hide it
    return lift(Jet2<double>{jet.f * jet.f, 2 * jet.f * jet.fd, 2 * (jet.fd * jet.fd + jet.f * jet.fdd)}, t);
  }

  void set_time(const T& t) {
    time = t;
    for (int k : moving) {
      f[static_cast<std::size_t>(k)] = evaluate(elements->right_sides[static_cast<std::size_t>(k)], t);
    }
    for (const AlternateRow& row : elements->alternates) {
      const bool swap = std::abs(plain(f[static_cast<std::size_t>(row.normal.f)].f)) > kAlternateAbove;
      dp1[static_cast<std::size_t>(row.primary)] = swap ? row.alternate : row.normal;
    }
  }

  static constexpr double kAlternateAbove = 0.9;  // the scene contract's |f|
  std::vector<int> moving;                        // right-hand sides that depend on time
};

}  // namespace poinsot
