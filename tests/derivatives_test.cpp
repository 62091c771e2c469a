// Derivatives of every formulation.
#include "formulations/list.h"
#include "tests/support/derivative_tests.h"

namespace poinsot::test {

INSTANTIATE_TYPED_TEST_SUITE_P(Formulations, Derivatives, WithFormulations<::testing::Types>, FormulationNames);

}  // namespace poinsot::test
