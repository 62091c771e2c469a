// Derivatives of formulation rA.
#include "formulations/rA.h"
#include "tests/support/derivative_tests.h"

namespace poinsot::test {

INSTANTIATE_TYPED_TEST_SUITE_P(rA, Derivatives, ::testing::Types<RA>);

}  // namespace poinsot::test
