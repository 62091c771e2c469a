#include "formulations/registry.h"

#include <algorithm>

#include "formulations/make.h"
#include "formulations/rA.h"
#include "formulations/reps.h"
#include "formulations/rp.h"

namespace poinsot {
namespace {

constexpr FormulationEntry kFormulations[] = {
    {RA::name, RA::about, RA::space, make_rA},
    {RP::name, RP::about, RP::space, make_rp},
    {REPS::name, REPS::about, REPS::space, make_reps},
};

}  // namespace

Registry<FormulationEntry>& formulations() {
  static Registry<FormulationEntry> table("formulation", kFormulations);
  return table;
}

const FormulationEntry& intrinsic_formulation() {
  return *std::find_if(formulations().begin(), formulations().end(),
                       [](const FormulationEntry& entry) { return entry.space == CoordinateSpace::lie_group; });
}

}  // namespace poinsot
