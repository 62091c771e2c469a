#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>

#include "bench/stability/edges.h"
#include "core/input_error.h"
#include "core/projected.h"

namespace poinsot::stability {

std::span<const Family> families() {
  static const std::vector<Family> all = [] {
    std::vector<Family> families;
    for (const auto& edges : {edges_of_rotation(), edges_of_loops(), edges_of_sizes(), edges_of_runs()})
      families.insert(families.end(), edges.begin(), edges.end());
    return families;
  }();
  return all;
}

const Family& require_family(std::string_view name) {
  const auto at = std::ranges::find(families(), name, &Family::name);
  if (at != families().end()) return *at;
  throw InputError(fmt::format("--family: found \"{}\", expected one of {}", name,
                               fmt::join(projected(families(), &Family::name), ", ")));
}

std::vector<const Family*> require_families(const std::vector<std::string>& names) {
  std::vector<const Family*> all;
  if (names.empty())
    for (const Family& family : families()) all.push_back(&family);
  for (const std::string& name : names) all.push_back(&require_family(name));
  return all;
}

Axis accuracy(std::vector<double> steps, std::vector<double> quick, std::vector<double> tolerances,
              std::vector<double> quick_tolerances) {
  return {Axis::accuracy,        "step, s | rtol",           "", std::move(steps), std::move(quick), 0,
          std::move(tolerances), std::move(quick_tolerances)};
}

}  // namespace poinsot::stability
