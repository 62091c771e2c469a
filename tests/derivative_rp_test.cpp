// Derivatives of formulation rp.
#include "formulations/rp.h"
#include "tests/support/derivative_tests.h"

namespace poinsot::test {

INSTANTIATE_TYPED_TEST_SUITE_P(rp, Derivatives, ::testing::Types<RP>);

}  // namespace poinsot::test
