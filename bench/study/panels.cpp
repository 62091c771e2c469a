#include "bench/study/panels.h"

#include <fmt/format.h>

#include "bench/study/output_file.h"
#include "bench/study/plot.h"

namespace poinsot::study {
namespace fs = std::filesystem;

Table points_table(const PanelPlot& plot) {
  Table table{plot.file, plot.title, "", {"panel", "series", "variant", "x", "y", "low", "high", "in_fit"}};
  const auto number = [](double value) { return fmt::format("{:.10g}", value); };
  for (const Curve& curve : plot.curves)
    for (const Point& point : curve.points)
      table.rows.push_back({curve.panel, curve.series, curve.variant, number(point.x), number(point.y),
                            plot.bands ? number(point.low) : "", plot.bands ? number(point.high) : "",
                            point.in_fit ? "1" : "0"});
  return table;
}

std::vector<std::string> layout_notes(const PanelPlot& plot) {
  const auto scale = [](bool log) { return log ? "log" : "linear"; };
  return {fmt::format("title: {}", plot.title),
          fmt::format("x: {}", plot.x),
          fmt::format("y: {}", plot.y),
          fmt::format("x scale: {}", scale(plot.log_x)),
          fmt::format("y scale: {}", scale(plot.log_y)),
          fmt::format("columns: {}", plot.columns),
          fmt::format("shared: {}", plot.shared ? "yes" : "no"),
          fmt::format("joined: {}", plot.joined ? "yes" : "no")};
}

std::string write_plots(const std::vector<PanelPlot>& plots, const fs::path& directory,
                        const std::vector<std::string>& foot) {
  std::vector<Plot> drawings;
  for (const PanelPlot& plot : plots) {
    OutputFile file(directory / (plot.file + ".csv"));
    std::vector<std::string> notes = layout_notes(plot);
    notes.insert(notes.end(), foot.begin(), foot.end());
    file.write(csv(points_table(plot), notes));
    file.commit();
    drawings.push_back({file.target(), directory / plot.file});
  }
  return draw("panels", drawings);
}

}  // namespace poinsot::study
