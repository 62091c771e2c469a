// The maps of a suite: families computed into a folder, their cells as CSV, pictures of them by
// bench/study/plots/maps.py, and the tables of what they come to.
//
//   const auto maps = map_families(require_families({}), {.quick = true}, {.folder = "results"});
//   const std::string why_not_drawn = write_maps(maps, "results", foot);
//   study::write_report(stability_report(maps, false, foot), "results", "stability");
#pragma once

#include <filesystem>
#include <functional>
#include <string>
#include <vector>

#include "bench/stability/suite.h"
#include "bench/study/report.h"

namespace poinsot::stability {

struct Mapped {
  const Family* family;
  std::vector<Cell> cells;  // by method
  bool drawn = false;       // there is a picture
};

struct Mapping {
  std::filesystem::path folder;  // its NAME.part keep the cells; those that are there are not computed again
  bool fresh = false;            // but for this
  int threads = 0;               // 0: one for each processor
};

// At intervals, by the thread that called: how many cells of all are there, and at which family it is.
using MapsTold = std::function<void(double there, double all, const Family& family)>;

// After an interruption (core/interruption.h) those that are complete.
std::vector<Mapped> map_families(const std::vector<const Family*>& families, const Extent& extent,
                                 const Mapping& mapping, const MapsTold& told = {});

// Of all other families those that lie in the folder, of runs before, as far as write_maps() tells of a cell. What is
// torn is left out, and told.
std::vector<Mapped> maps_before(const std::filesystem::path& folder, const std::vector<const Family*>& anew,
                                std::vector<std::string>& notices);

int count(const std::vector<Cell>& cells, Verdict verdict);

// DIR/NAME.csv of each, .svg and .png. Returns why there are no pictures, empty where there are.
std::string write_maps(std::vector<Mapped>& maps, const std::filesystem::path& directory,
                       const std::vector<std::string>& foot);

// Verdicts by family; which methods are accurate over all of a family, and what the others come to; results that were
// wrong or told, each.
std::vector<study::Table> tables(const std::vector<Mapped>& maps);
// These tables under what the families are and their pictures; with the amplification's.
study::Report stability_report(const std::vector<Mapped>& maps, bool amplification,
                               const std::vector<std::string>& foot);

}  // namespace poinsot::stability
