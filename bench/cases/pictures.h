// Pictures of a study's table: histograms, points, curves, and how many times longer one setting takes than another.
//
//   "pictures": [
//     {"file": "stroke", "histogram": "x.range", "bins": 40},
//     {"file": "sweep", "points": {"x": "l", "y": "x.range", "series": "formulation"}},
//     {"file": "curves", "curves": {"x": "px", "y": "py", "series": "l"}},            // kept at given times: a case a
//     curve
//     {"file": "speed_up", "ratio": {"of": "seconds", "by": "formulation", "to": "rA", "over": "bodies"}}]
//
// A ratio compares cases that differ in the setting alone. Given are the geometric mean over all of them and its 95 %
// confidence interval, exp(m ± t s/√n) of the mean m and the deviation s of the logarithms (Student's t).
#pragma once

#include <string>
#include <vector>

#include "core/json_value.h"

namespace poinsot::cases {

struct Kept;

struct Picture {
  enum Kind { histogram, points, curves, ratio } kind = histogram;
  std::string file, title;
  std::string x, y, series;  // columns; of curves x and y are names of quantities; of a ratio y is what is compared
  std::string by, to;        // of a ratio: the setting, and the value of it that the others are compared with
  int bins = 0;
  bool log_x = false, log_y = false;
};

// "pictures" of a study whose table has these columns. Throws InputError.
std::vector<Picture> read_pictures(const JsonValue& study, const std::vector<std::string>& columns, const Kept& kept);

}  // namespace poinsot::cases
