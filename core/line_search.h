// The lines of a JSON text where values stand, by key path: for messages, and only once there is one.
#pragma once

#include <map>
#include <string>
#include <string_view>
#include <vector>

namespace poinsot {

// Whether a text has more than one line, so that it helps to tell which.
bool has_lines(std::string_view text);

class LineSearch {
 public:
  // Goes through the text for these paths (JSON pointers), and for whatever they are in.
  LineSearch(std::string_view text, const std::vector<std::string>& paths);

  // Of the path, or of the innermost there is around it: of what is missing. 0: there is none, as in a text of one
  // line.
  int line(std::string path) const;
  // The string "name" of the object at the path; empty where it has none.
  std::string name(const std::string& path) const;

 private:
  std::map<std::string, int> lines_;
  std::map<std::string, std::string> names_;
};

}  // namespace poinsot
