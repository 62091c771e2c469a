// The formulations there are, in the order in which they are listed.
#pragma once

#include "formulations/rA.h"
#include "formulations/reps.h"
#include "formulations/rp.h"

namespace poinsot {

// As arguments of any template that takes types: the registry's entries, the tests' suites.
template <template <class...> class Of>
using WithFormulations = Of<RA, RP, REPS>;

}  // namespace poinsot
