// How the reactions Gᵀλ vary with the position at fixed λ: the second variation of every row, weighed by its λ.
//
// Before Ŵ: bodies' S = Σ λ w s̄ᵀ for H(S), and blocks E(s)ᵀE(z) between variations. For a row u·v with δs = E(s) W δx
//   λ δ²(u·v) = H(λ v ūᵀ + λ u v̄ᵀ) + 2 λ δuᵀδv,
// collected per body and per pair of bodies that meet in one row, in the ambient form of formulations/rows.h.
#pragma once

#include <algorithm>
#include <vector>

#include "core/index.h"
#include "formulations/rows.h"

namespace poinsot {

template <class F, class T>
struct SecondVariation {
  using C = Configuration<F, T>;
  using AA = Eigen::Matrix<T, F::ambient, F::ambient>;
  using RA3 = Eigen::Matrix<T, 3, F::ambient>;
  struct OnBody {  // of bodies whose position and orientation, or two of whose own vectors, meet in one row
    Mat3<T> rr = Mat3<T>::Zero();
    RA3 rx = RA3::Zero();
    RA3 xr_transposed = RA3::Zero();
    AA xx = AA::Zero();
    Vec3<T> moment = Vec3<T>::Zero();  // of velocity rows; its variation at a moment that stays is not in xx
  };
  struct OnPair {  // (i, j) and, mirrored, (j, i)
    AA xx_ij = AA::Zero(), xx_ji = AA::Zero();
  };
  struct OnPairWithR {  // xr blocks are kept transposed
    T rr = T(0);
    RA3 rx_ij = RA3::Zero(), rx_ji = RA3::Zero(), xr_ij_transposed = RA3::Zero(), xr_ji_transposed = RA3::Zero();
  };

  explicit SecondVariation(const Elements& of)
      : elements(of),
        S(index(of.nb)),
        bodies_(index(of.bodies_own)),
        pairs_(of.pairs.size()),
        pairs_with_r_(index(of.pairs_with_r)) {}

  void compute(const C& c, const T* lambda) {
    clear();
    const Elements& e = *c.elements;
    const auto s = [&](int k) -> const Vec3<T>& { return c.s[index(k)]; };
    const auto bar = [&](int k) { return c.s_bar(k); };
    const auto on_S = [&](int of, const Vec3<T>& weighed, const Vec3<T>& s_bar) {
      if (of != kGround) S[index(of)] += weighed * s_bar.transpose();
    };
    const auto directions = [&](const RowBase& k, const Vec3<T>& u, const Vec3<T>& u_bar, int v) {
      const T l = lambda[k.row];
      on_S(k.i, l * s(v), u_bar);
      on_S(k.j, l * u, bar(v));
      if (k.pair < 0) return;
      const auto block = C::EtE(l * u, s(v));
      pair(k.pair).xx_ij += block;
      pair(k.pair).xx_ji += block.transpose();
    };
    for (const DP1Row& k : c.dp1) directions(k, s(k.u), bar(k.u), k.v);
    for (const AngleRow& k : e.angle) {
      using std::cos, std::sin;
      const T &f = c.f[index(k.f)].f, sn = sin(f), cs = cos(f);
      directions(k, Rows<F, T>::driven(c, k), cs * bar(k.b) - sn * bar(k.a), k.v);
    }
    for (const DP2Row& k : e.dp2) {
      const T l = lambda[k.row];
      const Vec3<T> a = l * s(k.a), d = l * c.span(k.i, k.j, k.p, k.q);
      on_S(k.i, d, bar(k.a));
      on_S(k.i, -a, bar(k.p));
      on_S(k.j, a, bar(k.q));
      if (k.i != kGround) {
        auto& own = body(k.i);
        own.rx -= C::E(a);
        own.xr_transposed -= C::E(a);
        const auto block = C::EtE(a, s(k.p));
        own.xx -= block + block.transpose();
      }
      if (k.pair < 0) continue;
      pair_with_r(k.pair).rx_ji += C::E(a);
      pair_with_r(k.pair).xr_ij_transposed += C::E(a);
      const auto block = C::EtE(a, s(k.q));
      pair(k.pair).xx_ij += block;
      pair(k.pair).xx_ji += block.transpose();
    }
    for (const DRow& k : e.d) {
      const T l = T(2) * lambda[k.row];
      const Vec3<T> d = l * c.span(k.i, k.j, k.p, k.q);
      on_S(k.i, -d, bar(k.p));
      on_S(k.j, d, bar(k.q));
      const auto own = [&](int of, int point) {
        if (of == kGround) return;
        auto& mine = body(of);
        mine.rr.diagonal().array() += l;
        mine.rx += C::E(l * s(point));
        mine.xr_transposed += C::E(l * s(point));
        mine.xx += C::EtE(l * s(point), s(point));
      };
      own(k.i, k.p);
      own(k.j, k.q);
      if (k.pair < 0) continue;
      auto& with_r = pair_with_r(k.pair);
      with_r.rr -= l;
      with_r.rx_ij -= C::E(l * s(k.q));
      with_r.rx_ji -= C::E(l * s(k.p));
      with_r.xr_ij_transposed -= C::E(l * s(k.p));
      with_r.xr_ji_transposed -= C::E(l * s(k.q));
      const auto block = C::EtE(l * s(k.p), s(k.q));
      pair(k.pair).xx_ij -= block;
      pair(k.pair).xx_ji -= block.transpose();
    }
    for (const CDRow& k : e.cd) {
      const Vec3<T> n = lambda[k.row] * k.c.template cast<T>();
      on_S(k.i, -n, bar(k.p));
      on_S(k.j, n, bar(k.q));
    }
    for (const CoincidenceRows& k : e.coincidences) {
      const Vec3<T> force = Eigen::Map<const Vec3<T>>(lambda + k.row);
      on_S(k.i, -force, bar(k.p));
      on_S(k.j, force, bar(k.q));
    }
    for (const PfaffianRow& k : e.pfaffian) {  // the reaction Ψᵀλ, forces and moments, varies with a_j; no mirror
      const Vec3<T> a = lambda[k.row] * s(k.a);
      const auto acts = [&](int of, const Vec3<T>& s_of, const Vec3<T>& force) {
        if (of == kGround) return;
        body(of).moment += s_of.cross(force);
        body(of).xx.template topRows<3>() -= tilde<T>(force) * C::E(s_of);
      };
      acts(k.i, s(k.p), -a);
      acts(k.j, s(k.q), a);
      if (k.j != kGround) {
        body(k.j).rx += C::E(a);
        body(k.j).xx.template topRows<3>() += tilde<T>(s(k.q)) * C::E(a);
      }
      if (k.pair < 0) continue;
      pair_with_r(k.pair).rx_ij -= C::E(a);
      pair(k.pair).xx_ij.template topRows<3>() -= tilde<T>(s(k.p)) * C::E(a);
    }
  }

  OnBody& body(int b) { return bodies_[index(elements.body_own[index(b)])]; }
  OnPair& pair(int k) { return pairs_[index(k)]; }
  OnPairWithR& pair_with_r(int k) { return pairs_with_r_[index(elements.pairs[index(k)].with_r)]; }

  const Elements& elements;
  std::vector<Mat3<T>> S;

 private:
  void clear() {
    for (Mat3<T>& sum : S) sum.setZero();
    std::fill(bodies_.begin(), bodies_.end(), OnBody());
    std::fill(pairs_.begin(), pairs_.end(), OnPair());
    std::fill(pairs_with_r_.begin(), pairs_with_r_.end(), OnPairWithR());
  }

  std::vector<OnBody> bodies_;
  std::vector<OnPair> pairs_;
  std::vector<OnPairWithR> pairs_with_r_;
};

}  // namespace poinsot
