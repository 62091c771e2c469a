// The derivative checks of the formulations in the list. They stand apart, since optimized as what runs is they would
// take as long to compile.
#include <array>

#include "formulations/derivative_checker.h"
#include "formulations/list.h"

namespace poinsot {
namespace {

template <class... F>
struct Checks {
  static constexpr std::array all{&check_derivatives_in<F>...};
};
[[gnu::used]] constexpr auto kChecks = WithFormulations<Checks>::all;  // instantiates them

}  // namespace
}  // namespace poinsot
