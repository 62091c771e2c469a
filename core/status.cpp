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

Status with_settings(Status status, std::string_view settings) {
  const bool alone = status.remedy == 0;
  status.settings = status.message.size();
  if (alone) status.remedy = status.settings;
  status.message.append(alone ? "; " : ", or ").append(settings);
  return status;
}

void Status::explain(std::string_view why) {
  const std::size_t at = remedy > 0 ? remedy : message.size();
  message.insert(at, std::string("; ").append(why));
  if (remedy > 0) remedy += why.size() + 2;
  if (settings > 0) settings += why.size() + 2;
}

}  // namespace poinsot
