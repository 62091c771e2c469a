// A table of points in a file, as a scene names it: columns are read or refused, and the scene with them.
#include "bench/study/csv.h"
#include "core/input_error.h"
#include "core/model.h"
#include "core/scene_reader.h"
#include "core/table_file.h"
#include "tests/fuzz/input_file.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace poinsot;
  static const fuzz::InputFile file("table.csv");
  static const std::string scene = (file.folder() / "scene.json").string();
  file.write(fuzz::text_of(data, size));
  const auto attempt = [](auto read) {
    try {
      read();
    } catch (const InputError&) {
    }
  };
  attempt([] { (void)read_columns(file.path(), 1, 3); });
  attempt([] { (void)study::read_csv(file.path()); });
  const std::string rest =
      R"json(}}, "bodies": [{"name": "b", "mass": 1, "inertia": [1, 1, 1], "position": [0, 0, 0]}],
             "forces": [{"type": "force", "body": "b", "force": ["f(t)", 0, 0]}]})json";
  for (const std::string columns : {R"json(, "columns": [0, 1])json", R"json(, "columns": [2, 0])json"})
    attempt([&] {
      (void)compile(
          parse_scene(R"json({"scene": 1, "tables": {"f": {"file": "table.csv")json" + columns + rest, scene));
    });
  return 0;
}
