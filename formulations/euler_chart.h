// The three charts of the reps formulation: body-fixed frames in which a rotation's ZXZ Euler angles are taken.
//
// A = R(φ, θ, ψ) C with C one of three cyclic permutations of the axes: axis k of the scene's body frame is axis
// (k + chart) mod 3 of the chart's frame. Chart 0 is the scene's own frame. Of any rotation at least one chart has
// |sin θ| ≥ √(2/3).
#pragma once

#include <cmath>

#include "core/so3.h"

namespace poinsot {

struct EulerChart {
  template <class T>
  static Mat3<T> to_scene(int chart, const Mat3<T>& R) {
    if (chart == 0) return R;
    Mat3<T> A;
    for (int k = 0; k < 3; ++k) A.col(k) = R.col(axis(chart, k));
    return A;
  }
  template <class T>
  static Vec3<T> vector_to_scene(int chart, const Vec3<T>& c) {
    return {c[axis(chart, 0)], c[axis(chart, 1)], c[axis(chart, 2)]};
  }
  template <class T>
  static Vec3<T> vector_to_chart(int chart, const Vec3<T>& s) {
    Vec3<T> c;
    for (int k = 0; k < 3; ++k) c[axis(chart, k)] = s[k];
    return c;
  }
  template <class T>
  static Mat3<T> inertia_to_chart(int chart, const Mat3<T>& J) {
    if (chart == 0) return J;
    Mat3<T> Jc;
    for (int k = 0; k < 3; ++k) {
      for (int l = 0; l < 3; ++l) Jc(axis(chart, k), axis(chart, l)) = J(k, l);
    }
    return Jc;
  }

  // The chart's z axis is the scene's axis (2 − chart) mod 3 = column of A; sin θ is its distance from the global z.
  template <class T>
  static T sin_theta(const Mat3<T>& A, int chart) {
    using std::sqrt;
    const int column = (2 - chart + 3) % 3;
    return sqrt(A(0, column) * A(0, column) + A(1, column) * A(1, column));
  }
  template <class T>
  static int best(const Mat3<T>& A) {
    int found = 0;
    for (int chart = 1; chart < 3; ++chart) {
      if (plain(sin_theta(A, chart)) > plain(sin_theta(A, found))) found = chart;
    }
    return found;
  }
  // φ, θ, ψ of A, and the chart they are in.
  template <class T>
  static void angles(const Mat3<T>& A, int chart, T* x) {
    using std::atan2;
    Mat3<T> R;
    for (int k = 0; k < 3; ++k) R.col(axis(chart, k)) = A.col(k);
    x[0] = atan2(R(0, 2), -R(1, 2));
    x[1] = atan2(sin_theta(A, chart), R(2, 2));
    x[2] = atan2(R(2, 0), R(2, 1));
    x[3] = T(chart);
  }

 private:
  static int axis(int chart, int k) { return (k + chart) % 3; }
};

}  // namespace poinsot
