// The kept rows of a study are taken or left out. A line that begins with a blank is given its checksum, or no input
// would come past that.
#include <fmt/format.h>

#include "bench/cases/case_table.h"
#include "bench/study/cache.h"
#include "core/input_error.h"
#include "tests/fuzz/input_file.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace poinsot;
  static const fuzz::InputFile file("cases.part");
  static const cases::Study study =
      cases::read_study(std::filesystem::canonical(POINSOT_SOURCE_DIR) / "tests/fuzz/rows.json");
  std::string text;
  for (std::string_view rest = fuzz::text_of(data, size); !rest.empty();) {
    const std::size_t end = std::min(rest.find('\n'), rest.size() - 1) + 1;
    const std::string_view line = rest.substr(0, end), body = line.substr(0, line.find('\n'));
    text +=
        line.starts_with(' ') ? fmt::format("{:016x}{}", study::content_hash(body.substr(1)), line) : std::string(line);
    rest.remove_prefix(end);
  }
  std::filesystem::remove(file.path());
  cases::CaseTable(study).open(file.path());  // writes what stands before the rows
  std::ofstream(file.path(), std::ios::binary | std::ios::app) << text;
  try {
    cases::CaseTable table(study);
    table.open(file.path());
    (void)table.read(file.path(), false);
    for (std::int64_t number = 0; number < study.size(); ++number)
      if (table.has(number)) (void)table.fields(number);
    table.write(cases::Selection(study, false), file.folder() / "cases.csv");
  } catch (const InputError&) {
  }
  return 0;
}
