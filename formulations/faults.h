// Which function of a model has no finite value where a mechanism stands, and why: for messages, once a run has failed.
#pragma once

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <string>

#include "core/index.h"
#include "core/model_faults.h"
#include "formulations/callbacks.h"
#include "formulations/configuration.h"
#include "formulations/torsion.h"

namespace poinsot {

// "at t = 1 s driver 'motor': '1/(t - 1)' is not finite", the first there is; empty where all are finite.
template <Formulation F>
std::string first_fault(const Configuration<F, double>& c) {
  const Elements& e = *c.elements;
  if (std::string of_time = fault_of_functions(*e.model, c.time); !of_time.empty()) return of_time;
  // Where the state is not finite itself, a law is not what made it so.
  const auto of_law = [&](const ElementLaw& s, const std::string& name, double x, double v) -> std::string {
    if (!s.law || !std::isfinite(x) || !std::isfinite(v)) return {};
    const std::string what = s.law->law_fault({c.time, x, v});
    return what.empty() ? what : fault_sentence(c.time, fmt::format("force '{}'", name), what);
  };
  for (std::size_t k = 0; k < e.springs.size(); ++k) {
    const SpringElement& s = e.springs[k];
    const Vec3<double> d = c.span(s.i, s.j, s.p, s.q);
    const double l = d.norm(), rate = s.damped && l > 0 ? d.dot(c.rigid_span_rate(s.i, s.j, s.p, s.q)) / l : 0;
    if (std::string what = of_law(s, e.model->springs[k].name, l - s.length, rate); !what.empty()) return what;
  }
  for (std::size_t k = 0; k < e.torsions.size(); ++k) {
    const TorsionSpringElement& s = e.torsions[k];
    const double x = Torsion<F, double>::angle(c, s, c.twist[k]) - s.angle;
    const double rate = typename Torsion<F, double>::Twist(c, s, c.twist[k]).rate;
    if (std::string what = of_law(s, e.model->torsions[k].spring.name, x, rate); !what.empty()) return what;
  }
  for (CallbackLoads& k : c.callbacks) {
    bool finite = true;
    Callbacks<F, double>::loads(
        c, k, [&](int, const Vector3& f, const Vector3& n) { finite = finite && f.allFinite() && n.allFinite(); });
    const bool standing = std::ranges::all_of(k.states, [](const BodyState& s) {
      return s.r.allFinite() && s.A.allFinite() && s.rd.allFinite() && s.w.allFinite();
    });
    if (!finite && standing)
      return fault_sentence(c.time, fmt::format("force '{}'", k.force->name),
                            "its function gave a load that is not finite");
  }
  return {};
}

}  // namespace poinsot
