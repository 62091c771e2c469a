// The functions of a scene that vary with time by themselves: of drivers, of forces, and laws of springs, which do so
// at a fixed state.
#pragma once

#include <vector>

#include "core/model.h"

namespace poinsot {

// As the scene writes them; what a program computes is left out, nothing of it being known ahead. They live as long as
// the model.
inline std::vector<const Expression*> functions_of_time(const Model& model) {
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

}  // namespace poinsot
