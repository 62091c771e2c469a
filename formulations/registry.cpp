#include "formulations/registry.h"

#include <algorithm>
#include <iterator>

#include "formulations/make.h"

namespace poinsot {
namespace {

constexpr FormulationEntry kFormulations[] = {
    {"rA", "orientation matrix on SO(3), angular velocity; no orientation is singular", make_rA},
    {"rp", "Euler parameters with a normalization constraint per body; no orientation is singular", make_rp},
    {"reps", "ZXZ Euler angles; the body-fixed frame is chosen anew near sin(theta) = 0", make_reps},
};

}  // namespace

std::span<const FormulationEntry> formulations() {
  return kFormulations;
}

const FormulationEntry* find_formulation(std::string_view name) {
  const auto at = std::find_if(std::begin(kFormulations), std::end(kFormulations),
                               [&](const FormulationEntry& entry) { return entry.name == name; });
  return at == std::end(kFormulations) ? nullptr : at;
}

}  // namespace poinsot
