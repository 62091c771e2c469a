#include "bench/study/csv.h"

namespace poinsot::study {

std::vector<std::string> csv_fields(std::string_view line) {
  std::vector<std::string> result(1);
  bool quoted = false;
  for (std::size_t k = 0; k < line.size(); ++k) {
    if (line[k] == '"' && quoted && k + 1 < line.size() && line[k + 1] == '"')
      result.back() += line[++k];
    else if (line[k] == '"')
      quoted = !quoted;
    else if (line[k] == ',' && !quoted)
      result.emplace_back();
    else
      result.back() += line[k];
  }
  return result;
}

}  // namespace poinsot::study
