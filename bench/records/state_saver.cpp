#include "bench/records/state_saver.h"

#include "core/saved_scene.h"

namespace poinsot::records {

StateSaver::StateSaver(const std::filesystem::path& file, const Scene& scene)
    : file_(file), scene_(scene), bodies_(scene.bodies.size()) {}

void StateSaver::keep(const Sample& sample) {
  time_ = sample.t;
  sample.problem.to_bodies(sample.a, bodies_);
  twists_.resize(sample.problem.model().torsions.size());
  for (std::size_t k = 0; k < twists_.size(); ++k) twists_[k] = sample.problem.twist(static_cast<int>(k));
}

void StateSaver::write() {
  file_.write(saved_scene(scene_, time_, bodies_, twists_));
}

}  // namespace poinsot::records
