#include "core/status.h"

#include <iterator>
#include <utility>

namespace poinsot {

std::string_view name(Failure failure) {
  // In the order of the enumeration.
  static constexpr std::string_view kNames[] = {
      "ok",
      "not_converged",
      "singular_matrix",
      "not_finite",
      "inconsistent_state",
      "constraint_lost",
      "singular_position",
      "rotation_too_large",
      "step_size_too_small",
      "refused",
      "interrupted",
  };
  static_assert(std::size(kNames) == static_cast<std::size_t>(Failure::interrupted) + 1);
  return kNames[static_cast<std::size_t>(failure)];
}

Status with_remedy(Failure failure, double time, std::string message, std::string_view remedy) {
  Status status{failure, time, std::move(message)};
  status.remedy = status.message.size();
  status.message.append("; ").append(remedy);
  return status;
}

}  // namespace poinsot
