#include "integrators/stepping/functions_of_time.h"

#include <algorithm>
#include <cmath>

namespace poinsot {

std::vector<const Expression*> functions_of_time(const Model& model) {
  std::vector<const Expression*> functions;
  const auto add = [&](const Expression& f) {
    if (!f.is_constant() && !f.is_function()) functions.push_back(&f);
  };
  for (const Row& row : model.rows) {
    add(row.f);
    if (row.alternate) add(row.alternate->f);
  }
  for (const PointForce& force : model.point_forces)
    for (const Expression& f : force.force) add(f);
  for (const Torque& torque : model.torques)
    for (const Expression& f : torque.torque) add(f);
  for (const Spring& spring : model.springs)
    if (spring.law) add(*spring.law);
  for (const TorsionElement& element : model.torsions)
    if (element.spring.law) add(*element.spring.law);
  return functions;
}

Jet2<double> value_at(const Expression& f, double t) {
  return f.along(Arguments<Jet2<double>>{{t, 1, 0}, {1, 0, 0}, {1, 0, 0}});
}

double size_until(const Expression& f, double end) {
  if (const double most = f.range({{0, end}, {1, 1}, {1, 1}}).f.size(); std::isfinite(most)) return most;
  constexpr int kSamples = 64;
  double largest = 0;
  for (int k = 0; k <= kSamples; ++k)
    if (const double x = std::abs(value_at(f, end * k / kSamples).f); std::isfinite(x)) largest = std::max(largest, x);
  return largest;
}

}  // namespace poinsot
