#include "bench/study/advice.h"

#include <algorithm>
#include <memory>

#include "bench/study/scene_waste.h"
#include "integrators/start/initial_state.h"
#include "integrators/start/rank.h"

namespace poinsot::study {
namespace {

// Then kinematics computes the motion, too.
bool without_freedom(const Scene& scene) {
  const auto model = std::make_shared<const Model>(compile(scene));
  const auto pfaffian = [](const Row& row) { return row.type == RowType::pfaffian; };
  return std::none_of(model->rows.begin(), model->rows.end(), pfaffian) &&
         analyze_rank(model, given_state(*model), RankNames::none).degrees_of_freedom() == 0;
}

}  // namespace

Advice advise(const Scene& scene, double end, const Asked& asked, const Cache& cache,
              std::vector<std::string>& notices) {
  Advice advice;
  advice.reference = reference(scene, {end, end / kOutputs}, cache, notices);
  if (advice.reference.given < 0) return advice;
  for (const std::size_t quantity : asked.quantities)
    if (advice.reference.agreement[quantity] > asked.accuracy) advice.unresolved.push_back(quantity);
  advice.calibration = calibrate(Sweep(scene, end, advice.reference), advice.reference, asked, without_freedom(scene));
  advice.waste = scene_waste(scene, advice.reference.motion);
  return advice;
}

}  // namespace poinsot::study
