// Derivatives of formulation reps.
#include "formulations/reps.h"
#include "tests/support/derivative_tests.h"

namespace poinsot::test {

INSTANTIATE_TYPED_TEST_SUITE_P(reps, Derivatives, ::testing::Types<REPS>);

}  // namespace poinsot::test
