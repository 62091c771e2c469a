// Messages without whose element it is and on which line (core/places.h), for tests of the rest.
#pragma once

#include <string>

namespace poinsot::test {

// Without "(joint 'hinge', line 7)" at the end; which has tests of its own.
inline std::string without_place(const std::string& message) {
  const std::size_t at = message.rfind(" (");
  const bool place = at != message.npos && message.ends_with(')') &&
                     (message.find('\'', at) != message.npos || message.compare(at, 7, " (line ") == 0);
  return place ? message.substr(0, at) : message;
}

}  // namespace poinsot::test
