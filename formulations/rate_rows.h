// How the velocity constraints G v − ν vary with the position at fixed v: one kernel per kind of row, any formulation.
//
//   Φ = u·v − f:  δ(G v − ν) = v̇·δu + v·δu̇ + u̇·δv + u·δv̇,   δs = E(s) W δx,  δṡ = (∂ṡ/∂x) δx
//
// A row is (−g, x_i | g, x_j): g for r_j and −g for r_i, and the rows for the orientation variables. Needs
// compute_s_dot.
#pragma once

#include "core/index.h"
#include "formulations/rows.h"

namespace poinsot {

template <class F, class T>
class RateRows {
 public:
  using C = Configuration<F, T>;
  using X = Eigen::Matrix<T, F::m, 1>;

  struct Variation {
    int row, i, j;
    X xi, xj;
    Vec3<T> g;
  };

  // visit(variation, has_r): every holonomic row, kind by kind.
  template <class Visit>
  static void holonomic(const C& c, Visit&& visit) {
    const Elements& e = *c.elements;
    const Vec3<T> none = Vec3<T>::Zero();
    const auto s = [&](int k) -> const Vec3<T>& { return c.s[index(k)]; };
    const auto sd = [&](int k) -> const Vec3<T>& { return c.s_dot[index(k)]; };
    for (const DP1Row& k : c.dp1) {
      visit(Variation{k.row, k.i, k.j, moved(c, k.i, s(k.u), sd(k.v)) + turned(c, k.i, c.s_bar(k.u), s(k.v)),
                      moved(c, k.j, s(k.v), sd(k.u)) + turned(c, k.j, c.s_bar(k.v), s(k.u)), none},
            std::false_type());
    }
    for (const AngleRow& k : e.angle) {
      using std::cos, std::sin;
      const T &f = c.f[index(k.f)].f, sn = sin(f), cs = cos(f);
      const Vec3<T> u = Rows<F, T>::driven(c, k), u_t = Rows<F, T>::driven_rate(c, k);
      const Vec3<T> ud = cs * sd(k.b) - sn * sd(k.a) + u_t, u_bar = cs * c.s_bar(k.b) - sn * c.s_bar(k.a);
      visit(Variation{k.row, k.i, k.j,
                      moved(c, k.i, u, sd(k.v)) + moved(c, k.i, u_t, s(k.v)) + turned(c, k.i, u_bar, s(k.v)),
                      moved(c, k.j, s(k.v), ud) + turned(c, k.j, c.s_bar(k.v), u), none},
            std::false_type());
    }
    for (const DP2Row& k : e.dp2) {
      const Vec3<T> d = c.span(k.i, k.j, k.p, k.q), dd = c.span_rate(k.i, k.j, k.p, k.q);
      const auto [xi, xj] = along(c, k, s(k.a), sd(k.a));
      visit(Variation{k.row, k.i, k.j, moved(c, k.i, s(k.a), dd) + turned(c, k.i, c.s_bar(k.a), d) + xi, xj, sd(k.a)},
            std::true_type());
    }
    for (const DRow& k : e.d) {
      const Vec3<T> wd = T(2) * c.span_rate(k.i, k.j, k.p, k.q);
      const auto [xi, xj] = along(c, k, Vec3<T>(T(2) * c.span(k.i, k.j, k.p, k.q)), wd);
      visit(Variation{k.row, k.i, k.j, xi, xj, wd}, std::true_type());
    }
    for (const CDRow& k : e.cd) {
      const auto [xi, xj] = along(c, k, Vec3<T>(k.c.template cast<T>()), none);
      visit(Variation{k.row, k.i, k.j, xi, xj, none}, std::false_type());
    }
    for (const CoincidenceRows& k : e.coincidences) {
      for (int l = 0; l < 3; ++l) {
        const auto [xi, xj] = along(c, k, Vec3<T>(Vec3<T>::Unit(l)), none);
        visit(Variation{k.row + l, k.i, k.j, xi, xj, none}, std::false_type());
      }
    }
  }

  template <class Visit>
  static void velocity(const C& c, Visit&& visit) {
    for (const PfaffianRow& k : c.elements->pfaffian) {
      const Vec3<T>& a = c.s[index(k.a)];
      const Vec3<T> dd = c.rigid_span_rate(k.i, k.j, k.p, k.q);
      visit(Variation{k.row, k.i, k.j, -swept(c, k.i, k.p, a), swept(c, k.j, k.q, a) + moved(c, k.j, a, dd),
                      Vec3<T>::Zero()},
            std::false_type());
    }
  }

 private:
  // w·δs
  static X moved(const C& c, int body, const Vec3<T>& s, const Vec3<T>& w) {
    if (body == kGround) return X::Zero();
    return c.at[index(body)].W().transpose() * C::Et_times(s, w);
  }
  // w·δṡ
  static X turned(const C& c, int body, const Vec3<T>& s_bar, const Vec3<T>& w) {
    if (body == kGround) return X::Zero();
    return F::s_dot_variation(c.at[index(body)], c.rate[index(body)], c.xd(body), s_bar).transpose() * w;
  }
  // w·δ(ω × s)
  static X swept(const C& c, int body, int marker, const Vec3<T>& w) {
    if (body == kGround) return X::Zero();
    return c.turn_rate_variation(body, marker).transpose() * w;
  }
  // ẇ·δd + w·δḋ without r, as rows for the two bodies
  template <class Row>
  static std::pair<X, X> along(const C& c, const Row& k, const Vec3<T>& w, const Vec3<T>& w_dot) {
    const auto of = [&](int body, int marker) {
      return X(moved(c, body, c.s[index(marker)], w_dot) + turned(c, body, c.s_bar(marker), w));
    };
    return {-of(k.i, k.p), of(k.j, k.q)};
  }
};

}  // namespace poinsot
