// A study is read or refused, with the scenes of models/ beside it, and has the cases that it says.
#include "bench/cases/study_file.h"
#include "core/input_error.h"
#include "tests/fuzz/input_file.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace poinsot;
  static const fuzz::InputFile place("models");
  static const std::filesystem::path file = [] {  // scenes are looked up beside the study, as in bench/studies
    std::filesystem::create_directory_symlink(std::filesystem::canonical(POINSOT_SOURCE_DIR) / "models", place.path());
    std::filesystem::create_directories(place.folder() / "bench" / "studies");
    return place.folder() / "bench" / "studies" / "study.json";
  }();
  std::ofstream(file, std::ios::binary | std::ios::trunc) << fuzz::text_of(data, size);
  try {
    const cases::Study study = cases::read_study(file);
    const std::int64_t all = study.size();
    for (const std::int64_t number : {std::int64_t{0}, all / 2, all - 1})
      if (number >= 0 && number < all) (void)cases::key_of(study, cases::case_of(study, number));
    (void)cases::parse_content(study.content);
  } catch (const InputError&) {
  }
  return 0;
}
