// Families computed into a folder: the maps of a suite in a few lines.
//
//   const auto maps = map_families(require_families({}), {.quick = true}, {.folder = "results"});
//   const bool pictures = write_maps(maps, "results", foot).empty();
//   study::write_report(stability_report(maps, pictures, false, foot), "results", "stability");
#pragma once

#include <filesystem>
#include <functional>
#include <vector>

#include "bench/stability/maps.h"
#include "bench/stability/suite.h"

namespace poinsot::stability {

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

}  // namespace poinsot::stability
