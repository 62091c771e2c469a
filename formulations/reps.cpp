#include "formulations/reps.h"

#include "formulations/formulation_entry.h"

namespace poinsot {

template FormulationEntry formulation_entry<REPS>();

}  // namespace poinsot
