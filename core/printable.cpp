#include "core/printable.h"

#include <fmt/format.h>

namespace poinsot {

std::string printable(std::string_view text) {
  std::string shown;
  shown.reserve(text.size());
  for (std::size_t k = 0; k < text.size(); ++k) {
    const auto byte = static_cast<unsigned char>(text[k]);
    const auto next = k + 1 < text.size() ? static_cast<unsigned char>(text[k + 1]) : 0u;
    if (byte < 0x20 || byte == 0x7f) {
      shown += fmt::format("\\u{:04x}", byte);
    } else if (byte == 0xc2 && next >= 0x80 && next < 0xa0) {  // C1 in UTF-8; U+009B begins an escape sequence
      shown += fmt::format("\\u{:04x}", next);
      ++k;
    } else {
      shown += text[k];
    }
  }
  return shown;
}

}  // namespace poinsot
