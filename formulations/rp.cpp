#include "formulations/rp.h"

#include "formulations/make.h"
#include "formulations/mechanism_problem.h"

namespace poinsot {

std::unique_ptr<Problem> make_rp(std::shared_ptr<const Model> model, std::span<const int> dropped) {
  return std::make_unique<MechanismProblem<RP>>(std::make_shared<const Elements>(std::move(model), dropped));
}

}  // namespace poinsot
