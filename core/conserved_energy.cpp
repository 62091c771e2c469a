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
// Of a point, by its place: of a force that stays as it is in space.
EnergyFate of_force(const PointForce& force) {
  const bool stays = force.frame == Frame::global && std::ranges::all_of(force.force, &Expression::is_constant);
  return stays || !works(force.force) ? EnergyFate::kept : EnergyFate::unknown;
}

bool works(const Row& row) {
  if (row.type == RowType::pfaffian) return !is_nothing(row.f);
  return !row.f.is_constant() || (row.alternate && !row.alternate->f.is_constant());
}

EnergyFate of_damping(double damping) {
  return damping == 0 ? EnergyFate::kept : damping > 0 ? EnergyFate::taken : EnergyFate::unknown;
}

// Of a spring or torsion spring.
template <class Spring>
EnergyFate of_spring(const Spring& spring) {
  if (!spring.law) return of_damping(spring.damping);
  return spring.law->depends_on_rate() || spring.law->depends_on_time() ? EnergyFate::unknown : EnergyFate::kept;
}

}  // namespace

std::vector<EnergyFate> energy_fates(const Model& model, std::span<const int> mechanism) {
  std::vector<EnergyFate> fates(mechanism_count(mechanism), EnergyFate::kept);
  const auto moved = [&](int body, EnergyFate by = EnergyFate::unknown) {
    if (body == kGround) return;
    EnergyFate& fate = fates[index(mechanism[index(body)])];
    fate = std::max(fate, by);
  };
  const auto both = [&](int i, int j, EnergyFate by = EnergyFate::unknown) { moved(i == kGround ? j : i, by); };
  for (const Row& row : model.rows)
    if (works(row)) both(row.i, row.j);
  for (const PointForce& force : model.point_forces) moved(force.body, of_force(force));
  for (const Torque& torque : model.torques)
    if (works(torque.torque)) moved(torque.body);
  for (const Spring& spring : model.springs) both(spring.i, spring.j, of_spring(spring));
  for (const TorsionElement& torsion : model.torsions)
    both(torsion.spring.i, torsion.spring.j, of_spring(torsion.spring));
  for (const LinearDrag& drag : model.drags)
    moved(drag.body, std::max(of_damping(drag.translational), of_damping(drag.rotational)));
  for (const CallbackForce& callback : model.callbacks)
    for (const int body : callback.bodies) moved(body);
  return fates;
}

bool conserves_energy(const Model& model) {
  return std::ranges::all_of(energy_fates(model, mechanisms(model)),
                             [](EnergyFate fate) { return fate == EnergyFate::kept; }) &&
         std::ranges::none_of(model.point_forces, [](const PointForce& force) { return works(force.force); });
}

}  // namespace poinsot
