// A panel of curves as SVG that stands in the page: its colours are the page's (light, dark, print), its labels text.
#pragma once

#include <string>
#include <vector>

namespace poinsot::report {

struct SvgPoint {
  double x, y;
  std::string tip = {};  // what is told of it when it is pointed at
  bool strong = false;
};

struct SvgCurve {
  std::string name;
  int colour = 0;  // 0 to kColours − 1; kGrey: one of those that are not spoken of
  int marker = 0;  // kLine: none
  std::vector<SvgPoint> points = {};
  std::vector<double> low = {}, high = {};  // of a band, as long as the points
  bool dashed = false;
  bool labelled = false;  // its name at its end
  bool joined = true;     // by a line
};
inline constexpr int kColours = 10, kGrey = -1, kLine = -1;

struct SvgPanel {
  std::string title, x, y;
  std::string alt;  // what it shows, for those who do not see it
  bool log_x = true, log_y = true;
  bool falling_x = false;  // large values on the left
  std::vector<SvgCurve> curves;
};

// Points that a logarithmic axis cannot show are left out. Empty where there are none at all.
std::string svg(const SvgPanel& panel);

}  // namespace poinsot::report
