// The figures that `poinsot figures` computes: one table of them, each a function that runs the program and gives back
// curves to draw and tables of what was fitted to them.
#pragma once

#include <filesystem>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "bench/study/panels.h"
#include "bench/study/progress.h"
#include "bench/study/report.h"
#include "core/scene.h"

namespace poinsot::paper {

struct FigureRequest {
  std::filesystem::path models;
  bool quick = false;  // fewer and longer steps, shorter motions
  study::ProgressCallback progress = {};

  Scene scene(std::string_view model) const;
};

struct FigureResult {
  std::vector<study::PanelPlot> plots;
  std::vector<study::Table> tables;
  std::vector<std::string> summary;   // a sentence or two for the terminal
  std::vector<std::string> failures;  // runs there are no numbers of, and why
};

struct FigureEntry {
  std::string_view name, about;
  FigureResult (*compute)(const FigureRequest&);
};

std::span<const FigureEntry> figures();

FigureResult order_paper(const FigureRequest& request);
FigureResult order_integrators(const FigureRequest& request);
FigureResult order_controlled(const FigureRequest& request);
FigureResult solution_deltas(const FigureRequest& request);
FigureResult iterations(const FigureRequest& request);
FigureResult energy(const FigureRequest& request);

}  // namespace poinsot::paper
