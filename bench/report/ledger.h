// The numbers that sentences are made of: what is said is written down, in the same digits, for report_findings.csv.
#pragma once

#include <fmt/format.h>

#include <cmath>
#include <string>
#include <string_view>

#include "bench/study/interval.h"
#include "bench/study/range.h"
#include "bench/study/report.h"

namespace poinsot::report {

class Ledger {
 public:
  void begin(std::string finding) { finding_ = std::move(finding); }

  std::string text(std::string_view quantity, std::string value) {
    table_.rows.push_back({finding_, std::string(quantity), value, "", ""});
    return value;
  }
  std::string number(std::string_view quantity, double value, int decimals) {
    const double unit = std::pow(10.0, decimals);
    return text(quantity, fmt::format("{:.{}f}", std::round(value * unit) == 0 ? 0.0 : value, decimals));
  }
  std::string count(std::string_view quantity, std::size_t value) { return text(quantity, std::to_string(value)); }
  // "1.20 to 1.55"
  std::string range(std::string_view quantity, const study::Range& range, int decimals) {
    table_.rows.push_back({finding_, std::string(quantity), "", fmt::format("{:.{}f}", range.low, decimals),
                           fmt::format("{:.{}f}", range.high, decimals)});
    return range.text(decimals);
  }

  const study::Table& table() const { return table_; }

 private:
  std::string finding_;
  study::Table table_{
      "report_findings", "The numbers of the findings", "", {"finding", "quantity", "value", "from", "to"}};
};

}  // namespace poinsot::report
