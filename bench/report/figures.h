// Figures of the page, from the tables that hold their points.
#pragma once

#include <string>

#include "bench/study/csv.h"

namespace poinsot::report {

// Of a table of bench/study/panels.h: its panels and what their colours and markers mean. Empty where it is none.
std::string panels_html(const study::CsvTable& points, const std::string& title);

// Of a work-precision chart: a panel for each quantity, above it what follows from it. Methods that this names are in
// colour; a point tells its method, of these also setting, error, time and command.
std::string chart_html(const study::CsvTable& chart);

}  // namespace poinsot::report
