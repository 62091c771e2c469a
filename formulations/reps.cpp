#include "formulations/reps.h"

#include "formulations/make.h"
#include "formulations/mechanism_problem.h"

namespace poinsot {

std::unique_ptr<Problem> make_reps(std::shared_ptr<const Model> model, std::span<const int> dropped) {
  return std::make_unique<MechanismProblem<REPS>>(std::make_shared<const Elements>(std::move(model), dropped));
}

}  // namespace poinsot
