#include "core/conserved_energy.h"

#include <algorithm>

#include "core/index.h"
#include "core/mechanisms.h"

namespace poinsot {
namespace {

bool is_nothing(const Expression& f) {
  return f.is_constant() && f.at(0.0).f == 0;
}
bool works(const Expression (&components)[3]) {
  return !std::ranges::all_of(components, is_nothing);
}

bool works(const Row& row) {
  if (row.type == RowType::pfaffian) return !is_nothing(row.f);
  return !row.f.is_constant() || (row.alternate && !row.alternate->f.is_constant());
}

// Of a spring or torsion spring.
template <class Spring>
bool takes_or_gives(const Spring& spring) {
  return spring.law ? spring.law->depends_on_rate() || spring.law->depends_on_time() : spring.damping != 0;
}

}  // namespace

std::vector<bool> conserving_mechanisms(const Model& model, std::span<const int> mechanism) {
  std::vector<bool> conserves(mechanism_count(mechanism), true);
  const auto moved = [&](int body) {
    if (body != kGround) conserves[index(mechanism[index(body)])] = false;
  };
  const auto both = [&](int i, int j) { moved(i == kGround ? j : i); };
  for (const Row& row : model.rows)
    if (works(row)) both(row.i, row.j);
  for (const PointForce& force : model.point_forces)
    if (works(force.force)) moved(force.body);
  for (const Torque& torque : model.torques)
    if (works(torque.torque)) moved(torque.body);
  for (const Spring& spring : model.springs)
    if (takes_or_gives(spring)) both(spring.i, spring.j);
  for (const TorsionElement& torsion : model.torsions)
    if (takes_or_gives(torsion.spring)) both(torsion.spring.i, torsion.spring.j);
  for (const LinearDrag& drag : model.drags)
    if (drag.translational != 0 || drag.rotational != 0) moved(drag.body);
  for (const CallbackForce& callback : model.callbacks)
    for (const int body : callback.bodies) moved(body);
  return conserves;
}

bool conserves_energy(const Model& model) {
  const std::vector<bool> conserves = conserving_mechanisms(model, mechanisms(model));
  return std::ranges::all_of(conserves, [](bool one) { return one; });
}

}  // namespace poinsot
