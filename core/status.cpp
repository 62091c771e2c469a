#include "core/status.h"

namespace poinsot {

std::string_view name(Failure failure) {
  switch (failure) {
    case Failure::none:
      return "ok";
    case Failure::not_converged:
      return "not_converged";
    case Failure::singular_matrix:
      return "singular_matrix";
    case Failure::orientation_singularity:
      return "orientation_singularity";
    case Failure::not_finite:
      return "not_finite";
    case Failure::inconsistent_state:
      return "inconsistent_state";
    case Failure::constraint_lost:
      return "constraint_lost";
    case Failure::singular_position:
      return "singular_position";
    case Failure::rotation_too_large:
      return "rotation_too_large";
    case Failure::step_size_too_small:
      return "step_size_too_small";
    case Failure::refused:
      return "refused";
    case Failure::interrupted:
      return "interrupted";
  }
  return "unknown";
}

}  // namespace poinsot
