// Writes the scene as it stands at the last output time of a run (core/saved_scene.h).
#pragma once

#include <vector>

#include "bench/study/output_file.h"
#include "core/scene.h"
#include "integrators/integrator.h"

namespace poinsot::records {

class StateSaver {
 public:
  StateSaver(const std::filesystem::path& file, const Scene& scene);  // throws InputError

  void keep(const Sample& sample);
  void write();  // of a run that came to its end
  study::OutputFile& file() { return file_; }

 private:
  study::OutputFile file_;
  const Scene scene_;  // with its source
  double time_ = 0;
  std::vector<BodyState> bodies_;
  std::vector<double> twists_;
};

}  // namespace poinsot::records
