// A scene is read or refused; what is read compiles, and its functions of time can be asked.
#include "core/input_error.h"
#include "core/model.h"
#include "core/scene_reader.h"
#include "tests/fuzz/input_file.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace poinsot;
  try {
    const Model model = compile(parse_scene(fuzz::text_of(data, size), "scene.json"));
    for (const Row& row : model.rows) (void)row.f.at(0.5);
  } catch (const InputError&) {
  }
  return 0;
}
