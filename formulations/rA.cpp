#include "formulations/rA.h"

#include "formulations/formulation_entry.h"

namespace poinsot {

template FormulationEntry formulation_entry<RA>();

}  // namespace poinsot
