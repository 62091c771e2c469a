// The formulations there are. Help texts, error messages, conformance tests and benchmarks are made from this table.
#pragma once

#include <memory>
#include <span>
#include <string_view>

#include "formulations/problem.h"

namespace poinsot {

struct FormulationEntry {
  std::string_view name;
  std::string_view about;  // one line: what it is, what it refuses
  // A problem over the rows of the model; rows listed in `dropped` (sorted) take no part: they are dependent.
  std::unique_ptr<Problem> (*make)(std::shared_ptr<const Model> model, std::span<const int> dropped);
};

std::span<const FormulationEntry> formulations();
const FormulationEntry* find_formulation(std::string_view name);  // nullptr where no entry has the name

}  // namespace poinsot
