// Where two motions of one scene part: by frame of the first, how far apart the bodies are in the second.
#pragma once

#include <cstddef>
#include <vector>

#include "bench/view/frames.h"

namespace poinsot::view {

struct Apart {
  double position = 0;   // m, of the body for which it is largest
  double angle = 0;      // rad, likewise
  std::size_t body = 0;  // the one of `position`
};

// For the frames of `first` within the time of `second`.
std::vector<Apart> apart(const Motion& first, const Motion& second);

}  // namespace poinsot::view
