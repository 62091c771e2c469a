#include "bench/study/range.h"

#include <fmt/format.h>

namespace poinsot::study {

std::string Range::text(int decimals) const {
  return fmt::format("{:.{}f} to {:.{}f}", low, decimals, high, decimals);
}

}  // namespace poinsot::study
