#include "formulations/rA.h"

#include "formulations/formulation_entry.h"

namespace poinsot {

// In derivative_checks.cpp: optimized as what runs is, it would take as long to compile as that.
extern template std::vector<DerivativeCheck> check_derivatives_in<RA>(const Model&, std::span<const BodyState>);

template FormulationEntry formulation_entry<RA>();

}  // namespace poinsot
