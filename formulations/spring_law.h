// The tension of a spring and the torque of a torsion spring, for every scalar type: F(x, v, t) with its derivatives.
//
// Linear: F = stiffness x + damping v. A law is an expression (core/expression.h), whose derivatives are exact.
#pragma once

#include "core/dual.h"
#include "formulations/elements.h"
#include "formulations/law_potential.h"

namespace poinsot {

// F, ∂F/∂x and ∂F/∂v of a law. Of dual numbers F is one as well; the derivatives, whose derivatives are not known, are
// constants.
template <class T>
LawValue<T> law_value(const Expression& law, const Arguments<T>& at) {
  return law.law(at);
}
template <class T>
LawValue<Dual<T>> law_value(const Expression& law, const Arguments<Dual<T>>& at) {
  const LawValue<T> value = law.law(Arguments<T>{at.t.v, at.x.v, at.v.v});
  const Jet2<T> along = law.along(Arguments<Jet2<T>>{{at.t.v, at.t.d, 0}, {at.x.v, at.x.d, 0}, {at.v.v, at.v.d, 0}});
  return {{value.F, along.fd}, value.F_x, value.F_v};
}

template <class T>
LawValue<T> spring_force(const ElementLaw& k, const T& x, const T& v, const T& t) {
  if (k.law) return law_value(*k.law, Arguments<T>{t, x, v});
  T F = T(k.stiffness) * x;
  if (k.damped) F += T(k.damping) * v;
  return {F, T(k.stiffness), T(k.damping)};
}

template <class T>
T law_energy(LawPotential& stored, const T& x, const T& t) {
  return T(stored.at(plain(x), plain(t)));
}
template <class T>
Dual<T> law_energy(LawPotential& stored, const Dual<T>& x, const Dual<T>& t) {
  return {law_energy(stored, x.v, t.v), stored.law().law(Arguments<T>{t.v, x.v, T(0)}).F * x.d};
}

// The energy stored at x; of a law F(x, v, t) that of F(x, 0, t).
template <class T>
T potential(const ElementLaw& k, LawPotential& stored, const T& x, const T& t) {
  return k.law ? law_energy(stored, x, t) : T(0.5 * k.stiffness) * x * x;
}

}  // namespace poinsot
