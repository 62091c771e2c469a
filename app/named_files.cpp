#include "app/named_files.h"

#include <fmt/format.h>

#include "bench/study/output_file.h"
#include "bench/study/output_place.h"
#include "core/input_error.h"

namespace poinsot::app {
using namespace study;
namespace fs = std::filesystem;
namespace {

bool same_file(const fs::path& a, const fs::path& b) {
  if (a.empty() || b.empty() || is_device(b)) return false;
  return output_place(a).path == output_place(b).path;
}

}  // namespace

fs::path record_beside(const fs::path& file) {
  return file.empty() || is_device(file) ? fs::path() : fs::path(file).replace_extension(".run.json");
}

void refuse_overwriting(std::initializer_list<NamedFile> inputs, std::initializer_list<NamedFile> outputs) {
  for (const NamedFile& output : outputs)
    for (const NamedFile& input : inputs)
      if (same_file(output.path, input.path))
        throw InputError(fmt::format("{}: {} would overwrite {}; choose another name or folder for the output",
                                     output.path.string(), output.what, input.what));
  for (const NamedFile* a = outputs.begin(); a != outputs.end(); ++a)
    for (const NamedFile* b = a + 1; b != outputs.end(); ++b)
      if (same_file(a->path, b->path) ||
          (open_descriptor(a->path) >= 0 && open_descriptor(a->path) == open_descriptor(b->path)))
        throw InputError(fmt::format("{}: {} and {} would be the same file; choose different names", a->path.string(),
                                     a->what, b->what));
}

}  // namespace poinsot::app
