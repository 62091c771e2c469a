// The components of a reaction as files and messages name them: force (N) and moment (N m) on body j at the point of
// the joint or driver, global.
#pragma once

#include <array>
#include <string_view>

namespace poinsot {

inline constexpr std::array<std::string_view, 6> kReactionComponents{"fx", "fy", "fz", "nx", "ny", "nz"};

}  // namespace poinsot
