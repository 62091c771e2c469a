// The figures that `poinsot figures` computes: one table of them, each a function that runs the program and gives back
// curves to draw and tables of what was fitted to them.
#pragma once

#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include "app/panels.h"
#include "app/report.h"
#include "core/scene.h"

namespace poinsot::app {

struct FigureRequest {
  std::filesystem::path models;
  bool quick = false;  // fewer and longer steps, shorter motions
  bool progress = false;

  Scene scene(std::string_view model) const;
};

struct FigureResult {
  std::vector<PanelPlot> plots;
  std::vector<Table> tables;
  std::vector<std::string> summary;   // a sentence or two for the terminal
  std::vector<std::string> failures;  // runs there are no numbers of, and why
};

struct FigureEntry {
  std::string_view name, about;
  FigureResult (*compute)(const FigureRequest&);
};

FigureResult order_paper(const FigureRequest& request);
FigureResult order_integrators(const FigureRequest& request);
FigureResult order_controlled(const FigureRequest& request);
FigureResult solution_deltas(const FigureRequest& request);
FigureResult iterations(const FigureRequest& request);
FigureResult energy(const FigureRequest& request);

}  // namespace poinsot::app
