// The columns of a trajectory file after `t`: for each body NAME.COLUMN, in this order.
//
// r, ṙ and r̈ are those of the centre of mass, global, Euler parameters have e0 ≥ 0, ω̄ and its derivative are in the
// scene's body frame. The first seven are the body's pose.
#pragma once

#include <array>
#include <cstddef>
#include <string_view>

namespace poinsot::view {

inline constexpr std::array<std::string_view, 19> kTrajectoryColumns{
    "x", "y", "z", "e0", "e1", "e2", "e3", "vx", "vy", "vz", "wx", "wy", "wz", "ax", "ay", "az", "alx", "aly", "alz"};
inline constexpr std::size_t kPoseColumns = 7;

}  // namespace poinsot::view
