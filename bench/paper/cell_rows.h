// What the tables of measured cells have in common: finding cells, numbers as text, rows by mechanism and formulation.
#pragma once

#include <algorithm>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "bench/paper/mechanisms.h"
#include "bench/paper/published.h"
#include "bench/study/measure.h"
#include "bench/study/report.h"
#include "formulations/registry.h"

namespace poinsot::paper {

inline constexpr std::string_view kSubject = "rA";         // the formulation the paper proposes
inline constexpr const char* kLikeForLike = "simplified";  // the Newton matrix of the original codes
inline constexpr const char* kNone = "-";

std::string_view analysis_name(Analysis analysis);
std::string title(Analysis analysis, std::string_view what);
std::string file_name(Analysis analysis, std::string_view what);

const PaperMechanism& mechanism_of(const study::Cell& cell);  // by its name

// Null where there is none.
const study::Cell* find(std::span<const study::Cell> cells, Analysis analysis, const PaperMechanism& mechanism,
                        std::string_view formulation, std::string_view jacobian);
std::vector<std::string> jacobians_of(std::span<const study::Cell> cells);

// As text; what is not positive was not measured.
std::string number(double value, int decimals);

// One row for every mechanism and formulation that has cells; `fill` adds the columns after the first two.
template <class Fill>
void for_rows(study::Table& table, std::span<const study::Cell> cells, Analysis analysis,
              const std::vector<std::string>& jacobians, Fill&& fill) {
  for (const PaperMechanism& mechanism : kMechanisms) {
    if (analysis == Analysis::kinematics && !mechanism.driven) continue;
    for (const FormulationEntry& formulation : formulations()) {
      std::vector<std::string> row{std::string(mechanism.title), std::string(formulation.name)};
      std::vector<const study::Cell*> own;
      for (const std::string& jacobian : jacobians)
        own.push_back(find(cells, analysis, mechanism, formulation.name, jacobian));
      if (std::count(own.begin(), own.end(), nullptr) > 0) continue;
      fill(row, own, find_published(analysis, mechanism.file, formulation.name));
      table.rows.push_back(std::move(row));
    }
  }
}

}  // namespace poinsot::paper
