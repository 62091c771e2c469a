#include "bench/study/advice.h"

#include "bench/study/scene_check.h"
#include "bench/study/scene_waste.h"

namespace poinsot::study {
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
