// The constraint rows of a mechanism, one kernel per kind, for every formulation: every row is a dot product u·v −
// f(t).
//
// A row's gradient is (−g, e_i | g, e_j): g for r_j and −g for r_i, and for the orientations the ambient vectors
// e = Σ E(s)ᵀw over the attached vectors s the row depends on, which a formulation pulls back by Ŵᵀ; of a velocity row
// the moment alone, e = Σ [s × w; 0].
#pragma once

#include <algorithm>
#include <limits>
#include <span>
#include <vector>

#include "core/index.h"
#include "formulations/configuration.h"

namespace poinsot {

// Rows of the problem from `first` to before `end`, those of coincidences by their first; as it stands, all.
struct RowRange {
  int first = 0, end = std::numeric_limits<int>::max();
  bool whole() const { return end == std::numeric_limits<int>::max(); }
};

template <class F, class T>
class Rows {
 public:
  using C = Configuration<F, T>;
  using Ambient = typename C::Ambient;

  struct Gradient {
    int row, i, j;
    Ambient ei, ej;
    Vec3<T> g;
  };

  // visit(gradient, has_r, Phi): every holonomic row, kind by kind.
  template <class Visit>
  static void holonomic(const C& c, Visit&& visit, RowRange range = {}) {
    scalar(c, visit, range);
    for (const CoincidenceRows& k : of(c.elements->coincidences, range)) {
      const Vec3<T> d = c.span(k.i, k.j, k.p, k.q);
      for (int l = 0; l < 3; ++l) {
        Gradient g = along(k, c.s[index(k.p)], c.s[index(k.q)], Vec3<T>(Vec3<T>::Unit(l)));
        g.row += l;
        visit(g, std::true_type(), d[l]);
      }
    }
  }

  // The same without the rows of coincidences. The order is the order of assembly.
  template <class Visit>
  static void scalar(const C& c, Visit&& visit, RowRange range = {}) {
    const Elements& e = *c.elements;
    const auto s = [&](int k) -> const Vec3<T>& { return c.s[index(k)]; };
    for (const DP1Row& k : of(c.dp1, range)) {
      const Vec3<T>&u = s(k.u), &v = s(k.v);
      visit(direction_pair(k, u, v), std::false_type(), T(u.dot(v) - c.f[index(k.f)].f));
    }
    for (const AngleRow& k : of(e.angle, range)) {
      const Vec3<T> u = driven(c, k), v = s(k.v);
      visit(direction_pair(k, u, v), std::false_type(), T(u.dot(v)));
    }
    for (const DP2Row& k : of(e.dp2, range)) {
      const Vec3<T>& a = s(k.a);
      const Vec3<T> d = c.span(k.i, k.j, k.p, k.q);
      visit(Gradient{k.row, k.i, k.j, C::Et_times(a, d) - C::Et_times(s(k.p), a), C::Et_times(s(k.q), a), a},
            std::true_type(), T(a.dot(d) - c.f[index(k.f)].f));
    }
    for (const DRow& k : of(e.d, range)) {
      const Vec3<T> d = c.span(k.i, k.j, k.p, k.q);
      visit(along(k, s(k.p), s(k.q), Vec3<T>(T(2) * d)), std::true_type(), T(d.dot(d) - c.f[index(k.f)].f));
    }
    for (const CDRow& k : of(e.cd, range)) {
      const Vec3<T> n = k.c.template cast<T>();
      visit(along(k, s(k.p), s(k.q), n), std::true_type(), T(n.dot(c.span(k.i, k.j, k.p, k.q)) - c.f[index(k.f)].f));
    }
  }

  // visit(gradient, has_r, Ψv − f): the velocity rows. Of bodies that are rigid: in rp, within a step of implicit
  // Euler, p·ṗ = −½ h ṗ·ṗ, and where rows are all but parallel the stretch in their place would lead them astray.
  template <class Visit>
  static void velocity(const C& c, Visit&& visit, RowRange range = {}) {
    for (const PfaffianRow& k : of(c.elements->pfaffian, range)) {
      const Vec3<T>& a = c.s[index(k.a)];
      visit(Gradient{k.row, k.i, k.j, -C::moment(c.s[index(k.p)], a), C::moment(c.s[index(k.q)], a), a},
            std::true_type(), T(a.dot(c.rigid_span_rate(k.i, k.j, k.p, k.q)) - c.f[index(k.f)].f));
    }
  }

  // Of rows of one kind, which ascend, those in the range.
  template <class Row>
  static std::span<const Row> of(const std::vector<Row>& rows, RowRange range) {
    if (range.whole()) return rows;
    const auto first = std::ranges::lower_bound(rows, range.first, {}, &RowBase::row);
    return {first, std::ranges::lower_bound(first, rows.end(), range.end, {}, &RowBase::row)};
  }

  // ν by row: ∂Φ/∂t with the opposite sign; f of a velocity row.
  static void nu(const C& c, T* out) {
    const Elements& e = *c.elements;
    const auto rate = [&](const auto& rows) {
      for (const auto& k : rows) out[k.row] = c.f[index(k.f)].fd;
    };
    rate(c.dp1), rate(e.dp2), rate(e.d), rate(e.cd);
    for (const CoincidenceRows& k : e.coincidences) std::fill_n(out + k.row, 3, T(0));
    for (const AngleRow& k : e.angle) {
      out[k.row] = -driven_rate(c, k).dot(c.s[index(k.v)]);
    }
    for (const PfaffianRow& k : e.pfaffian) out[k.row] = c.f[index(k.f)].f;
  }

  // γ = −(v·ü⁰ + 2 u̇·v̇ + u·v̈⁰) + f̈ by row; needs compute_s_dot. N by body: s̈⁰ = N s̄.
  static void gamma(const C& c, const std::vector<Mat3<T>>& N, T* out) {
    const Elements& e = *c.elements;
    const auto s = [&](int k) -> const Vec3<T>& { return c.s[index(k)]; };
    const auto sd = [&](int k) -> const Vec3<T>& { return c.s_dot[index(k)]; };
    const auto sdd = [&](int k) -> Vec3<T> {
      const int body = e.markers[index(k)].body;
      if (body == kGround) return Vec3<T>::Zero();
      return N[index(body)] * c.s_bar(k);
    };
    const auto rigid_sdd = [&](int k) -> Vec3<T> {  // (ω × s)˙ at ẍ = 0
      if constexpr (!F::normalized) return sdd(k);
      const Vec3<T> w = c.w(e.markers[index(k)].body);
      return w.cross(w.cross(s(k)));
    };
    for (const DP1Row& k : c.dp1) {
      out[k.row] = c.f[index(k.f)].fdd - s(k.v).dot(sdd(k.u)) - 2 * sd(k.u).dot(sd(k.v)) - s(k.u).dot(sdd(k.v));
    }
    for (const AngleRow& k : e.angle) {  // u = A_i ū(t): ü⁰ = N ū + 2 Ȧ ū' + A ū''
      using std::cos, std::sin;
      const Jet2<T>& f = c.f[index(k.f)];
      const T sn = sin(f.f), cs = cos(f.f);
      const auto u_of = [&](const Vec3<T>& a, const Vec3<T>& b) -> Vec3<T> { return cs * b - sn * a; };
      const auto u1_of = [&](const Vec3<T>& a, const Vec3<T>& b) -> Vec3<T> { return -f.fd * (cs * a + sn * b); };
      const Vec3<T> u = u_of(s(k.a), s(k.b)), u1 = u1_of(s(k.a), s(k.b));
      const Vec3<T> u2 = -f.fdd * (cs * s(k.a) + sn * s(k.b)) - f.fd * f.fd * u;
      const Vec3<T> ud = u_of(sd(k.a), sd(k.b)) + u1;
      const Vec3<T> udd = u_of(sdd(k.a), sdd(k.b)) + T(2) * u1_of(sd(k.a), sd(k.b)) + u2;
      out[k.row] = -s(k.v).dot(udd) - 2 * ud.dot(sd(k.v)) - u.dot(sdd(k.v));
    }
    for (const DP2Row& k : e.dp2) {
      const Vec3<T> d = c.span(k.i, k.j, k.p, k.q), dd = c.span_rate(k.i, k.j, k.p, k.q);
      out[k.row] = c.f[index(k.f)].fdd - d.dot(sdd(k.a)) - 2 * sd(k.a).dot(dd) - s(k.a).dot(sdd(k.q) - sdd(k.p));
    }
    for (const DRow& k : e.d) {
      const Vec3<T> d = c.span(k.i, k.j, k.p, k.q), dd = c.span_rate(k.i, k.j, k.p, k.q);
      out[k.row] = c.f[index(k.f)].fdd - 2 * d.dot(sdd(k.q) - sdd(k.p)) - 2 * dd.dot(dd);
    }
    for (const CDRow& k : e.cd) {
      out[k.row] = c.f[index(k.f)].fdd - k.c.template cast<T>().dot(sdd(k.q) - sdd(k.p));
    }
    for (const CoincidenceRows& k : e.coincidences) {
      Eigen::Map<Vec3<T>>{out + k.row} = sdd(k.p) - sdd(k.q);
    }
    for (const PfaffianRow& k : e.pfaffian) {
      const Vec3<T> dd = c.rigid_span_rate(k.i, k.j, k.p, k.q);
      out[k.row] = c.f[index(k.f)].fd - sd(k.a).dot(dd) - s(k.a).dot(rigid_sdd(k.q) - rigid_sdd(k.p));
    }
  }

  // u of an angle row, and A_i ∂ū/∂t.
  static Vec3<T> driven(const C& c, const AngleRow& k) {
    using std::cos, std::sin;
    const T& f = c.f[index(k.f)].f;
    return cos(f) * c.s[index(k.b)] - sin(f) * c.s[index(k.a)];
  }
  static Vec3<T> driven_rate(const C& c, const AngleRow& k) {
    using std::cos, std::sin;
    const Jet2<T>& f = c.f[index(k.f)];
    return -f.fd * (cos(f.f) * c.s[index(k.a)] + sin(f.f) * c.s[index(k.b)]);
  }

 private:
  static Gradient direction_pair(const RowBase& k, const Vec3<T>& u, const Vec3<T>& v) {
    const Ambient e = C::Et_times(u, v);
    Ambient other = e;  // [v × u; u·v]
    other.template head<3>() = -e.template head<3>();
    return {k.row, k.i, k.j, e, other, Vec3<T>::Zero()};
  }
  // Gradient of w·d at fixed w.
  static Gradient along(const RowBase& k, const Vec3<T>& p, const Vec3<T>& q, const Vec3<T>& w) {
    return {k.row, k.i, k.j, -C::Et_times(p, w), C::Et_times(q, w), w};
  }
};

}  // namespace poinsot
