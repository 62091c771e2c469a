// Tables that both folders of results have, of one file each, row by row.
#pragma once

#include <string>

#include "bench/report/differences.h"

namespace poinsot::report {

// raw.csv and charts, whose times are compared, too.
void compare_raw(const study::CsvTable& a, const study::CsvTable& b, Differences& told);
void compare_charts(const study::CsvTable& a, const study::CsvTable& b, Differences& told);
// The cases of two studies, told column by column: there may be very many. `origin_a` and `origin_b`: tables with the
// notes of their studies.
void compare_cases(const std::string& file, const study::CsvTable& a, const study::CsvTable& origin_a,
                   const study::CsvTable& b, const study::CsvTable& origin_b, Differences& told);
// Cell by cell: of the numbers that differ, how many and by how much.
void compare_values(const study::CsvTable& a, const study::CsvTable& b, Differences& told);

}  // namespace poinsot::report
