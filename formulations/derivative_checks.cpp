// The derivative checks of the formulations in the list, which need not be as fast as what runs.
#include <span>
#include <vector>

#include "formulations/derivative_checker.h"
#include "formulations/list.h"

namespace poinsot {

template std::vector<DerivativeCheck> check_derivatives_in<RA>(const Model&, std::span<const BodyState>);
template std::vector<DerivativeCheck> check_derivatives_in<RP>(const Model&, std::span<const BodyState>);
template std::vector<DerivativeCheck> check_derivatives_in<REPS>(const Model&, std::span<const BodyState>);

}  // namespace poinsot
