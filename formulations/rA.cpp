#include "formulations/rA.h"

#include "formulations/make.h"
#include "formulations/mechanism_problem.h"

namespace poinsot {

std::unique_ptr<Problem> make_rA(std::shared_ptr<const Model> model, std::span<const int> dropped) {
  return std::make_unique<MechanismProblem<RA>>(std::make_shared<const Elements>(std::move(model), dropped));
}

}  // namespace poinsot
