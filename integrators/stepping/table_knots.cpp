#include "integrators/stepping/table_knots.h"

#include "integrators/stepping/functions_of_time.h"

namespace poinsot {

TableKnots::TableKnots(const Model& model, double end, double rtol) {
  constexpr double kHidden = 0.1;  // of rtol
  const auto add = [&](const Expression& f) {
    if (f.asks_tables()) functions_.push_back({&f, kHidden * rtol * size_until(f, end)});
  };
  for (const PointForce& force : model.point_forces)
    for (const Expression& f : force.force) add(f);
  for (const Torque& torque : model.torques)
    for (const Expression& f : torque.torque) add(f);
}

double TableKnots::reach(double t, double to) const {
  for (const Function& of : functions_) {
    if (!(t < to)) break;
    const double h = to - t;
    const double s = first_knot(
        [&](double at, std::span<int> out) {
          of.f->cubics({t + at * h, 0, 0}, out);
        },
        [&](double at) { return h * of.f->at(t + at * h).fd; }, of.nothing);
    if (s < 1) to = t + s * h;
  }
  return to;
}

}  // namespace poinsot
