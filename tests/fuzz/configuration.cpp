// A configuration is read or refused, and what is read can be written and read again.
#include "core/input_error.h"
#include "integrators/settings_reader.h"
#include "tests/fuzz/input_file.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace poinsot;
  try {
    Settings settings, again;
    parse_settings(fuzz::text_of(data, size), "configuration.json", settings);
    check_counts(settings);
    const std::string text = to_json(settings);
    parse_settings(text, "written.json", again);
    if (to_json(again) != text) std::abort();
    std::vector<std::string> notices;
    fit_time_grid(settings, notices);
  } catch (const InputError&) {
  }
  return 0;
}
