// The paper's tables from measured cells, with its own figures and those of its two codes beside ours. Sentences with
// numbers in them are made from the numbers.
#pragma once

#include <span>
#include <string_view>

#include "bench/study/measure.h"
#include "bench/study/report.h"

namespace poinsot::paper {

study::Table constraint_counts(std::span<const Scene> scenes);  // one per mechanism, in order
// Of cells that differ in mechanism, formulation and jacobian only.
study::Table speed_up_table(std::span<const study::Cell> cells, Analysis analysis);
study::Table iterations_table(std::span<const study::Cell> cells, Analysis analysis);
// Ratios only where there are times of the codes on the processor, named as processor() of core/provenance.h names it.
study::Table against_original_table(std::span<const study::Cell> cells, Analysis analysis, std::string_view processor);

}  // namespace poinsot::paper
