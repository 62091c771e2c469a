#include "core/mechanisms.h"

#include <fmt/format.h>

#include <algorithm>
#include <numeric>

#include "core/index.h"

namespace poinsot {

std::vector<int> mechanisms(const Model& model) {
  std::vector<int> first(model.bodies.size());  // a body before it in its mechanism, in the end the first; or itself
  std::iota(first.begin(), first.end(), 0);
  const auto first_of = [&](int body) {
    while (first[index(body)] != body) body = first[index(body)] = first[index(first[index(body)])];
    return body;
  };
  const auto join = [&](int i, int j) {
    if (i == kGround || j == kGround) return;
    i = first_of(i), j = first_of(j);
    first[index(std::max(i, j))] = std::min(i, j);
  };
  for (const Row& row : model.rows) join(row.i, row.j);
  for (const Spring& spring : model.springs) join(spring.i, spring.j);
  for (const TorsionElement& torsion : model.torsions) join(torsion.spring.i, torsion.spring.j);
  for (const CallbackForce& callback : model.callbacks)
    for (const int body : callback.bodies) join(callback.bodies.front(), body);

  std::vector<int> number(first.size());
  int numbered = 0;
  for (int body = 0; body < static_cast<int>(first.size()); ++body)
    number[index(body)] = first_of(body) == body ? numbered++ : number[index(first_of(body))];
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
