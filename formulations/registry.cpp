#include "formulations/registry.h"

#include <algorithm>
#include <array>

#include "formulations/list.h"

namespace poinsot {
namespace {

template <class... F>
struct Entries {
  // Each is compiled in the formulation's own source file.
  static std::array<FormulationEntry, sizeof...(F)> all() { return {formulation_entry<F>()...}; }
};

}  // namespace

Registry<FormulationEntry>& formulations() {
  static Registry<FormulationEntry> table("formulation", WithFormulations<Entries>::all());
  return table;
}

const FormulationEntry& intrinsic_formulation() {
  return *std::find_if(formulations().begin(), formulations().end(),
                       [](const FormulationEntry& entry) { return entry.space == CoordinateSpace::lie_group; });
}

}  // namespace poinsot
