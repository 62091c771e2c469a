#include "bench/study/startable_scene.h"

#include <memory>

#include "integrators/start/initial_state.h"

namespace poinsot::study {

Scene read_startable_scene(const std::filesystem::path& file, const ParameterValues& set) {
  Scene scene = read_scene(file, set);
  naming(file, [&] { (void)find_initial_state(std::make_shared<const Model>(compile(scene)), Settings{}); });
  return scene;
}

}  // namespace poinsot::study
