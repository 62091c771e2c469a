// What a formulation must provide: how the orientation of one body is held, varied and differentiated.
//
// Everything else (constraints, forces, kinetics, Newton matrices) is written once over it. Per body the coordinates
// are q = (r, x), velocities v = (ṙ, ẋ), accelerations a = (r̈, ẍ), where x, ẋ and ẍ are the formulation's own: in rA
// the matrix A, the angular velocity ω̄ and ω̄̇. T is a scalar: double, long double, or a dual number in the derivative
// tests.
//
// An attached vector s = A s̄ varies by δs = E(s) Ŵ δx: Ŵ δx is the rotation δθ (global, by columns three numbers), and
// in rp, whose A(p) is homogeneous, fourth the stretch σ: E(s) = [−s̃, s]. s̈⁰ is the part of s̈ without accelerations.
#pragma once

#include <Eigen/Core>
#include <concepts>
#include <string_view>

#include "core/so3.h"

namespace poinsot {

// What kind of space the coordinates q and the velocities v of a formulation make.
enum class CoordinateSpace {
  lie_group,     // v is a velocity of the body itself, not the rate of coordinates: the retraction is no addition
  vector_space,  // q of all bodies is one vector and v = q̇ always: formulas for ordinary equations apply as they are
  charts,        // v = q̇ within a chart; where it becomes singular, accept() rewrites q, v and a in another one
};

// The sizes and properties.
template <class F>
concept FormulationTraits = requires {
  { F::name } -> std::convertible_to<std::string_view>;   // as in the configuration
  { F::about } -> std::convertible_to<std::string_view>;  // one line for `poinsot list`
  requires F::m == 3 || F::m == 4;                        // numbers in ẋ, ẍ and δx
  requires F::stored >= F::m;                             // numbers that hold x
  requires F::ambient == 3 || F::ambient == 4;            // rows of Ŵ: rotation, or rotation and stretch
  { F::space } -> std::convertible_to<CoordinateSpace>;
  { F::normalized } -> std::convertible_to<bool>;  // ½ xᵀx − ½ = 0 is a constraint of its own per body; x in `at.p`
  { F::inertia_depends_on_position } -> std::convertible_to<bool>;
  { F::simplified_keeps_rate_term } -> std::convertible_to<bool>;  // ∂/∂ẋ of the inertia in the simplified matrix
  requires F::space != CoordinateSpace::vector_space || F::stored == F::m;
  requires F::space != CoordinateSpace::lie_group || F::m == 3;  // δx is a rotation in the body frame
};

// Where a body stands and how it turns, computed once per configuration.
template <class F, class T>
concept FormulationState = requires(const typename F::template Position<T>& at,
                                    const typename F::template Velocity<T>& rate) {
  { at.A } -> std::convertible_to<const Mat3<T>&>;
  { at.W() } -> std::same_as<const Eigen::Matrix<T, F::ambient, F::m>&>;  // Ŵ
  { rate.w } -> std::convertible_to<const Vec3<T>&>;                      // ω̄, body
  { rate.wg } -> std::convertible_to<const Vec3<T>&>;                     // ω, global
  requires !F::normalized || requires {
    { at.p } -> std::convertible_to<const Vec4<T>&>;
  };
};

// x, xd, xdd, dx: a body's own numbers in q, v, a and δq. J: J̄, body. n: a torque, global. S = Σ w s̄ᵀ over attached
// vectors with fixed weights w.
template <class F, class T>
concept FormulationOn = FormulationState<F, T> &&
    requires(const T* x, const T* xd, const T* xdd, const T* dx, T* out, const Mat3<T>& J, const Mat3<T>& S,
             const Mat3<T>& A, const Vec3<T>& s_bar, const Vec3<T>& n, const Vec3<T>& w,
             typename F::template Position<T>& at, typename F::template Velocity<T>& rate) {
  F::position(x, at);         // everything of Position
  F::velocity(at, xd, rate);  // everything of Velocity

  // How attached vectors move: N with s̈⁰ = N s̄, ∂ṡ/∂x at fixed ẋ, and H(S) = Σ ∂((∂s/∂x)ᵀ w)/∂x.
  { F::A_ddot0(at, rate, xd) } -> std::same_as<Mat3<T>>;
  { F::s_dot_variation(at, rate, xd, s_bar) } -> std::same_as<Eigen::Matrix<T, 3, F::m>>;
  { F::H(at, S) } -> std::same_as<Eigen::Matrix<T, F::m, F::m>>;
  // Of torques: the variation of Ŵᵀ n at fixed n, and ∂ω/∂x at fixed ẋ.
  { F::torque_variation(at, n) } -> std::same_as<Eigen::Matrix<T, F::m, F::m>>;
  { F::angular_velocity_variation(at, rate, xd) } -> std::same_as<Eigen::Matrix<T, 3, F::m>>;

  // Kinetics: the orientation's part of M a minus the velocity terms, M, and the residual's ∂/∂ẋ and ∂/∂x.
  { F::inertia_residual(at, rate, xd, xdd, J) } -> std::same_as<Eigen::Matrix<T, F::m, 1>>;
  { F::mass(at, J) } -> std::same_as<Eigen::Matrix<T, F::m, F::m>>;
  { F::inertia_rate_variation(at, rate, xd, J) } -> std::same_as<Eigen::Matrix<T, F::m, F::m>>;
  { F::inertia_position_variation(at, rate, xd, xdd, J) } -> std::same_as<Eigen::Matrix<T, F::m, F::m>>;

  // x moved by δx: A exp(δx~), x + δx.
  F::retract(x, dx, out);
  // From and to A, ω̄ and ω̄̇. The x of every A is one by which ω̄ determines ẋ.
  F::from_rotation(A, out);
  F::rates_from(at, w, out);
  { F::angular_acceleration(at, rate, xd, xdd) } -> std::same_as<Vec3<T>>;
};

// Charts are changed between steps, on doubles only: x, ẋ and ẍ rewritten in place, true where they were.
template <class F>
concept Rechartable = requires(const typename F::template Position<double>& at,
                               const typename F::template Velocity<double>& rate, double* x, double* xd, double* xdd) {
  { F::rechart(at, rate, x, xd, xdd) } -> std::same_as<bool>;
};

template <class F>
concept Formulation = FormulationTraits<F> && FormulationOn<F, double> &&
    (F::space != CoordinateSpace::charts || Rechartable<F>);

}  // namespace poinsot
