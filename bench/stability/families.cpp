#include <fmt/format.h>

#include <vector>

#include "bench/stability/edges.h"
#include "core/input_error.h"

namespace poinsot::stability {

std::span<const Family> families() {
  static const std::vector<Family> all{
      euler_angles(),
      spin(),
      top(),
      dp1_driver(),
      flat_redundant(),
      flat_planar(),
      misalignment(),
      far_away(),
      mass_ratio(),
      skew_chain(),
      stiffness(),
      rounding_positions(),
      rounding_accelerations(),
      rounding_reactions(),
      inconsistent(),
      pulse(),
      smooth_pulse(),
      kinks(),
      drift(),
  };
  return all;
}

const Family& require_family(std::string_view name) {
  std::string known;
  for (const Family& family : families()) {
    if (family.name == name) return family;
    known += (known.empty() ? "" : ", ") + std::string(family.name);
  }
  throw InputError(fmt::format("--family: found \"{}\", expected one of {}", name, known));
}

std::vector<const Family*> require_families(const std::vector<std::string>& names) {
  std::vector<const Family*> all;
  if (names.empty())
    for (const Family& family : families()) all.push_back(&family);
  for (const std::string& name : names) all.push_back(&require_family(name));
  return all;
}

Axis accuracy() {
  return {Axis::accuracy, "step, s | rtol",          "",           {40, 160, 640, 2560},
          {40, 640},      {1e-4, 1e-6, 1e-8, 1e-10}, {1e-4, 1e-8}, 0};
}

}  // namespace poinsot::stability
