#include "bench/study/startable_scene.h"

#include <fmt/format.h>

#include <memory>

#include "core/input_error.h"
#include "core/json_document.h"
#include "core/places.h"
#include "core/scene_reader.h"
#include "integrators/start/initial_state.h"

namespace poinsot::study {

Scene read_startable_scene(const std::filesystem::path& file, const ParameterValues& set) {
  Scene scene = read_scene(file, set);
  try {
    (void)find_initial_state(std::make_shared<const Model>(compile(scene)), Settings{});
  } catch (const InputError& refused) {
    throw InputError(fmt::format("{}: {}", shown_input(file.string()),
                                 with_lines(with_key_paths(refused.what(), scene), read_text(file.string()))));
  }
  return scene;
}

}  // namespace poinsot::study
