#include "core/mechanisms.h"

#include <fmt/format.h>

#include <algorithm>

#include "core/index.h"
#include "core/joined.h"

namespace poinsot {

std::vector<int> mechanisms(const Model& model) {
  Joined joined(model.bodies.size());
  const auto join = [&](int i, int j) {
    if (i != kGround && j != kGround) joined.join(i, j);
  };
  for (const Row& row : model.rows) join(row.i, row.j);
  for (const Spring& spring : model.springs) join(spring.i, spring.j);
  for (const TorsionElement& torsion : model.torsions) join(torsion.spring.i, torsion.spring.j);
  for (const CallbackForce& callback : model.callbacks)
    for (const int body : callback.bodies) join(callback.bodies.front(), body);

  std::vector<int> number(model.bodies.size());
  int numbered = 0;
  for (int body = 0; body < static_cast<int>(number.size()); ++body)
    number[index(body)] = joined.first_of(body) == body ? numbered++ : number[index(joined.first_of(body))];
  return number;
}

std::size_t mechanism_count(std::span<const int> mechanism) {
  return mechanism.empty() ? 0 : index(*std::ranges::max_element(mechanism) + 1);
}

std::string of_mechanism(const Model& model, std::span<const int> mechanism, int number) {
  if (mechanism_count(mechanism) < 2) return {};
  const auto first = std::ranges::find(mechanism, number) - mechanism.begin();
  return fmt::format(" of the mechanism of body '{}'", model.bodies[index(first)].name);
}

}  // namespace poinsot
