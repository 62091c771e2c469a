#include "app/named_files.h"

#include <fmt/format.h>

#include "app/output_file.h"
#include "core/input_error.h"

namespace poinsot::app {
namespace fs = std::filesystem;
namespace {

bool same_file(const fs::path& a, const fs::path& b) {
  return !a.empty() && !b.empty() && fs::weakly_canonical(fs::absolute(a)) == fs::weakly_canonical(fs::absolute(b));
}

}  // namespace

fs::path record_beside(const fs::path& file) {
  return file.empty() || is_device(file) ? fs::path() : fs::path(file).replace_extension(".json");
}

void refuse_overwriting(std::initializer_list<NamedFile> inputs, std::initializer_list<NamedFile> outputs) {
  for (const NamedFile& output : outputs)
    for (const NamedFile& input : inputs)
      if (same_file(output.path, input.path))
        throw InputError(fmt::format("{}: {} would overwrite {}; choose another name or folder for the output",
                                     output.path.string(), output.what, input.what));
  for (const NamedFile* a = outputs.begin(); a != outputs.end(); ++a)
    for (const NamedFile* b = a + 1; b != outputs.end(); ++b)
      if (same_file(a->path, b->path) && !is_device(a->path))
        throw InputError(fmt::format("{}: {} and {} would be the same file; choose different names", a->path.string(),
                                     a->what, b->what));
}

}  // namespace poinsot::app
