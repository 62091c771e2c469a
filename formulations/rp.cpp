#include "formulations/rp.h"

#include "formulations/formulation_entry.h"

namespace poinsot {

template FormulationEntry formulation_entry<RP>();

}  // namespace poinsot
