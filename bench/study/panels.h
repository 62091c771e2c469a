// Curves in panels, as a CSV file and drawn from it by bench/study/plots/panels.py.
//
// A row of the CSV is a point: panel, series (its colour), variant (its marker), x, y, the band low to high where there
// is one, and whether the point is in the window of a fit. Notes below the rows say titles, axes and scales.
#pragma once

#include <string>
#include <vector>

#include "bench/study/report.h"

namespace poinsot::study {

struct Point {
  double x, y;
  bool in_fit = false;
  double low = 0, high = 0;  // of a band
};

struct Curve {
  std::string panel, series;
  std::string variant;  // kGuide: a line to compare with
  std::vector<Point> points = {};
};
inline constexpr const char* kGuide = "guide";

struct PanelPlot {
  std::string file;  // of CSV and pictures, without extension
  std::string title, x, y;
  bool log_x = true, log_y = true;
  bool bands = false;  // from low to high, y their middle
  int columns = 2;     // panels side by side
  bool shared = true;  // panels side by side have one vertical scale
  bool joined = true;  // by lines; a cloud of points is not
  std::vector<Curve> curves = {};
};

Table points_table(const PanelPlot& plot);
// What panels.py reads below the rows.
std::vector<std::string> layout_notes(const PanelPlot& plot);

// DIR/FILE.csv, .svg and .png for every plot. Returns why there are no pictures, empty where there are. Throws
// InputError where files cannot be written.
std::string write_plots(const std::vector<PanelPlot>& plots, const std::filesystem::path& directory,
                        const std::vector<std::string>& foot);

}  // namespace poinsot::study
