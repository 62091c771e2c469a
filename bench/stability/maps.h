// The maps of a suite: cells as CSV, pictures of them by bench/study/plots/maps.py, and the tables of what they come
// to.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "bench/stability/family.h"
#include "bench/stability/verdict.h"
#include "bench/study/report.h"

namespace poinsot::stability {

struct Mapped {
  const Family* family;
  std::vector<Cell> cells;  // by method
};

int count(const std::vector<Cell>& cells, Verdict verdict);

// DIR/NAME.csv of each, .svg and .png. Returns why there are no pictures, empty where there are.
std::string write_maps(const std::vector<Mapped>& maps, const std::filesystem::path& directory,
                       const std::vector<std::string>& foot);

// Verdicts by family; which methods are accurate over all of a family, and what the others come to; results that were
// wrong or told, each.
std::vector<study::Table> tables(const std::vector<Mapped>& maps);
// These tables under what the families are and, where there are pictures, those of the maps; with the amplification's.
study::Report stability_report(const std::vector<Mapped>& maps, bool pictures, bool amplification,
                               const std::vector<std::string>& foot);

}  // namespace poinsot::stability
