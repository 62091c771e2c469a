#include "bench/report/svg_panel.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "bench/report/html.h"
#include "bench/study/range.h"

namespace poinsot::report {
using study::Range;
namespace {

constexpr double kWidth = 480, kHeight = 300, kLeft = 62, kRight = 12, kTop = 12, kBottom = 44, kNames = 162;

// A number as a tick says it: "1e-4", "0.5", "2000".
std::string tick_text(double x) {
  if (x == 0 || (std::abs(x) >= 1e-2 && std::abs(x) < 1e5)) return fmt::format("{:.4g}", x);
  std::string text = fmt::format("{:.2e}", x);
  const std::size_t e = text.find('e');
  std::string digits = text.substr(0, e);
  while (digits.back() == '0') digits.pop_back();
  if (digits.back() == '.') digits.pop_back();
  return fmt::format("{}e{}", digits, std::stoi(text.substr(e + 1)));
}

class Axis {
 public:
  Axis(Range range, bool log, double from, double to) : log_(log), from_(from), to_(to) {
    low_ = log ? std::log10(range.low) : range.low;
    high_ = log ? std::log10(range.high) : range.high;
    const double room = std::max(0.03 * (high_ - low_), log            ? 0.1
                                                        : high_ > low_ ? 0
                                                                       : std::max(1e-3 * std::abs(high_), 1e-300));
    low_ -= room, high_ += room;
  }

  double at(double x) const { return from_ + (to_ - from_) * ((log_ ? std::log10(x) : x) - low_) / (high_ - low_); }

  std::vector<double> ticks() const {
    std::vector<double> all;
    if (!log_) {
      const double raw = (high_ - low_) / 5, unit = std::pow(10.0, std::floor(std::log10(raw)));
      const double step = unit * (raw > 5 * unit ? 10 : raw > 2 * unit ? 5 : raw > unit ? 2 : 1);
      for (double k = std::ceil(low_ / step); k * step <= high_; ++k) all.push_back(k == 0 ? 0 : k * step);
      return all;
    }
    const double decades = high_ - low_;
    const int every = std::max(1, static_cast<int>(std::ceil(decades / 6)));
    for (int k = static_cast<int>(std::floor(low_)); k <= high_; ++k)
      for (const double digit : {1.0, 2.0, 5.0}) {
        const double x = k + std::log10(digit);
        if (x < low_ || x > high_ || (digit > 1 && decades > 2.2) || (k % every != 0)) continue;
        all.push_back(std::pow(10.0, k) * digit);
      }
    return all;
  }

 private:
  bool log_;
  double from_, to_, low_, high_;
};

// Which points a logarithmic axis can show.
bool shown(const SvgPanel& panel, const SvgPoint& p) {
  return std::isfinite(p.x) && std::isfinite(p.y) && (!panel.log_x || p.x > 0) && (!panel.log_y || p.y > 0);
}

std::string colour_class(const SvgCurve& curve) {
  return curve.colour == kGrey ? "grey" : fmt::format("c{}", curve.colour % kColours);
}

std::string marker_path(int marker, double x, double y, double size) {
  switch (marker % 4) {
    case 0:
      return fmt::format("M{:.1f} {:.1f}a{s} {s} 0 1 0 {d} 0a{s} {s} 0 1 0 -{d} 0z", x - size, y, fmt::arg("s", size),
                         fmt::arg("d", 2 * size));
    case 1:
      return fmt::format("M{:.1f} {:.1f}h{d}v{d}h-{d}z", x - size, y - size, fmt::arg("d", 2 * size));
    case 2:
      return fmt::format("M{:.1f} {:.1f}l{s} {d}h-{d}z", x, y - size, fmt::arg("s", size), fmt::arg("d", 2 * size));
    default:
      return fmt::format("M{:.1f} {:.1f}l{s} {s}l-{s} {s}l-{s} -{s}z", x, y - size, fmt::arg("s", size));
  }
}

std::string axes_svg(const SvgPanel& panel, const Axis& x, const Axis& y, double right) {
  std::string text;
  for (const double t : x.ticks())
    text += fmt::format(
        "<path class=\"grid\" d=\"M{:.1f} {}V{}\"/><text class=\"tick\" x=\"{:.1f}\" y=\"{}\" "
        "text-anchor=\"middle\">{}</text>",
        x.at(t), kTop, kHeight - kBottom, x.at(t), kHeight - kBottom + 15, tick_text(t));
  for (const double t : y.ticks())
    text += fmt::format(
        "<path class=\"grid\" d=\"M{} {:.1f}H{}\"/><text class=\"tick\" x=\"{}\" y=\"{:.1f}\" "
        "text-anchor=\"end\">{}</text>",
        kLeft, y.at(t), right, kLeft - 5, y.at(t) + 4, tick_text(t));
  text += fmt::format("<path class=\"axis\" d=\"M{} {}V{}H{}\"/>", kLeft, kTop, kHeight - kBottom, right);
  text += fmt::format("<text x=\"{}\" y=\"{}\" text-anchor=\"middle\">{}</text>", (kLeft + right) / 2, kHeight - 8,
                      escape(panel.x + (panel.falling_x ? "   (more accurate →)" : "")));
  text += fmt::format("<text transform=\"translate(13 {})rotate(-90)\" text-anchor=\"middle\">{}</text>",
                      (kTop + kHeight - kBottom) / 2, escape(panel.y));
  return text;
}

// Points that tell the same are one path.
std::string marks_svg(const SvgPanel& panel, const SvgCurve& curve, const Axis& x, const Axis& y) {
  std::string text, path;
  const SvgPoint* last = nullptr;
  const auto finish = [&] {
    if (path.empty()) return;
    const std::string tip = last->tip.empty() ? "" : fmt::format("<title>{}</title>", escape(last->tip));
    text += fmt::format("<path class=\"m{}\" d=\"{}\">{}</path>", last->strong ? " strong" : "", path, tip);
    path.clear();
  };
  for (const SvgPoint& p : curve.points) {
    if (!shown(panel, p)) continue;
    if (last && (last->tip != p.tip || last->strong != p.strong)) finish();
    last = &p;
    path += marker_path(curve.marker, x.at(p.x), y.at(p.y), p.strong ? 4 : 3);
  }
  finish();
  return text;
}

std::string curve_svg(const SvgPanel& panel, const SvgCurve& curve, const Axis& x, const Axis& y) {
  std::string line, band, back;
  for (std::size_t k = 0; k < curve.points.size(); ++k) {
    const SvgPoint& p = curve.points[k];
    if (!shown(panel, p)) continue;
    line += fmt::format("{}{:.1f} {:.1f}", line.empty() ? "M" : "L", x.at(p.x), y.at(p.y));
    if (curve.low.empty()) continue;
    band += fmt::format("{}{:.1f} {:.1f}", band.empty() ? "M" : "L", x.at(p.x), y.at(curve.low[k]));
    back = fmt::format("L{:.1f} {:.1f}", x.at(p.x), y.at(curve.high[k])) + back;
  }
  if (!band.empty()) band = fmt::format("<path class=\"band\" d=\"{}{}z\"/>", band, back);
  if (curve.joined) line = fmt::format("<path class=\"l{}\" d=\"{}\"/>", curve.dashed ? " dashed" : "", line);
  return fmt::format("<g class=\"{}\">{}{}{}</g>\n", colour_class(curve), band, curve.joined ? line : "",
                     curve.marker == kLine ? "" : marks_svg(panel, curve, x, y));
}

// Names beside the last points, one below another where they would cover one another.
std::string names_svg(const SvgPanel& panel, const Axis& x, const Axis& y) {
  struct End {
    double x, y;
    const SvgCurve* curve;
  };
  std::vector<End> ends;
  for (const SvgCurve& curve : panel.curves) {
    if (!curve.labelled) continue;
    const SvgPoint* last = nullptr;
    for (const SvgPoint& p : curve.points)
      if (shown(panel, p) && (!last || x.at(p.x) > x.at(last->x))) last = &p;
    if (last) ends.push_back({x.at(last->x), y.at(last->y), &curve});
  }
  std::ranges::sort(ends, {}, &End::y);
  constexpr double line = 13;
  std::vector<double> at;
  for (const End& end : ends) at.push_back(std::max(end.y, at.empty() ? kTop + 6 : at.back() + line));
  constexpr double lowest = kHeight - kBottom - 4;
  double free = lowest + line;
  if (!at.empty() && at.back() > lowest)
    for (std::size_t k = at.size(); k-- > 0;) free = at[k] = std::min(at[k], free - line);
  std::string text;
  for (std::size_t k = 0; k < ends.size(); ++k)
    text += fmt::format(
        "<g class=\"{}\"><path class=\"lead\" d=\"M{:.1f} {:.1f}L{:.1f} {:.1f}\"/><text class=\"name\" x=\"{:.1f}\" "
        "y=\"{:.1f}\">{}</text></g>\n",
        colour_class(*ends[k].curve), ends[k].x + 4, ends[k].y, kWidth - kNames - 2, at[k], kWidth - kNames, at[k] + 4,
        escape(ends[k].curve->name));
  return text;
}

}  // namespace

std::string svg(const SvgPanel& panel) {
  Range xs, ys;
  bool names = false;
  for (const SvgCurve& curve : panel.curves) {
    names = names || curve.labelled;
    for (std::size_t k = 0; k < curve.points.size(); ++k) {
      const SvgPoint& p = curve.points[k];
      if (!shown(panel, p)) continue;
      xs.add(p.x), ys.add(p.y);
      if (!curve.low.empty()) ys.add(curve.low[k]), ys.add(curve.high[k]);
    }
  }
  if (xs.empty()) return {};
  const double right = kWidth - (names ? kNames + 14 : kRight);
  const Axis x(xs, panel.log_x, panel.falling_x ? right : kLeft, panel.falling_x ? kLeft : right);
  const Axis y(ys, panel.log_y, kHeight - kBottom, kTop);
  std::string text =
      fmt::format("<svg viewBox=\"0 0 {} {}\" role=\"img\" aria-label=\"{}\">\n", kWidth, kHeight, escape(panel.alt));
  text += axes_svg(panel, x, y, right);
  for (const bool grey : {true, false})
    for (const SvgCurve& curve : panel.curves)
      if ((curve.colour == kGrey) == grey) text += curve_svg(panel, curve, x, y);
  return text + names_svg(panel, x, y) + "</svg>\n";
}

}  // namespace poinsot::report
