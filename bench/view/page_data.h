// What a page is given, as JSON: the mechanism, and motions of it as packed numbers.
//
// Numbers are little-endian and in base64: times as float64, all else as float32, column by column over the frames.
// Columns of a motion: for each body those of kTrajectoryColumns (only the pose where the poses are many), then what is
// plotted of the whole mechanism ("curves"), then three for each force and torque. Positions are relative to "centres",
// three numbers a body, the middle of where it goes: float32 has seven digits, and these keep them.
//
// Two motions are compared here, in double precision: the distance of their positions and the angle between their
// orientations, of the body where it is largest, at the times of the first; where the second has no frame at such a
// time, it is interpolated as the page does (positions linearly, orientations on SO(3)).
//
// The text may stand in a script element of HTML whatever the names in it: outside ASCII, and for <, > and &, it is
// written with \u escapes.
#pragma once

#include <span>
#include <string>

#include "bench/view/frames.h"
#include "core/model.h"

namespace poinsot::view {

// `about`: the scene's. One motion, or two.
std::string page_data(const Model& model, const std::string& about, std::span<const Motion> motions);

}  // namespace poinsot::view
