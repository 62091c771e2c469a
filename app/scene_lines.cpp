#include "app/scene_lines.h"

#include "core/input_error.h"
#include "core/json_document.h"

namespace poinsot::app {

std::string with_lines_of(const std::string& file, std::string_view message) {
  if (message.find(" (/") == message.npos) return std::string(message);
  try {
    return with_lines(message, read_text(file));
  } catch (const InputError&) {  // it is gone
    return std::string(message);
  }
}

}  // namespace poinsot::app
