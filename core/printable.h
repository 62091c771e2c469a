// Text of others as a terminal or a message can show it: control characters, those of escape sequences among them,
// written out (\u001b), so that what a file calls something changes neither colours nor lines.
#pragma once

#include <string>
#include <string_view>

namespace poinsot {

// Control characters (C0, DEL, C1) as \uXXXX; everything else as it stands, what is not UTF-8 too.
std::string printable(std::string_view text);

}  // namespace poinsot
