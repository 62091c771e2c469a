// What is found to differ between two folders of results, as it is told (compare.h), and which times have changed
// beyond the noise.
#pragma once

#include <algorithm>
#include <functional>
#include <string>
#include <utility>
#include <vector>

#include "bench/report/compare.h"
#include "bench/report/raw_cells.h"
#include "bench/study/measure.h"

namespace poinsot::report {

// Empty, or why the times of two tables say nothing of one another.
std::string why_no_times(const study::CsvTable& a, const study::CsvTable& b);

class Differences {
 public:
  // What of a file is not compared, and why.
  void leave_out(const std::string& file, const std::string& what, const std::string& why);
  // Not what never says anything of another folder, but what would if it had been computed alike.
  void leave_out_all(const std::string& file, const std::string& why);

  void origin(const char* key, const std::string& a, const std::string& b);
  void only_a(std::string what) { told_.only_a.push_back(std::move(what)); }
  void only_b(std::string what) { told_.only_b.push_back(std::move(what)); }
  void changed(const std::string& file, const std::string& cell, const std::string& quantity, const std::string& before,
               const std::string& after);
  // compare(before, after) of what has the same name in both files; what one of them lacks is told.
  template <class Item, class Name, class Compare>
  void each(const std::string& file, const std::vector<Item>& before, const std::vector<Item>& after, const Name& name,
            const Compare& compare);

  // The k-th repetition beside the k-th.
  void times(const RawCell& a, const RawCell& b);
  struct Timed {
    double seconds, spread;
  };
  void times_by_spreads(const std::string& file, const std::string& cell, const Timed& a, const Timed& b,
                        const study::CommonSpread& common);

  Comparison told() &&;

 private:
  Comparison told_;
  std::vector<double> quotients_;
};

template <class Item, class Name, class Compare>
void Differences::each(const std::string& file, const std::vector<Item>& before, const std::vector<Item>& after,
                       const Name& name, const Compare& compare) {
  for (const Item& item : after)
    if (std::ranges::find(before, std::invoke(name, item), name) == before.end())
      only_b(file + ": " + std::invoke(name, item));
  for (const Item& item : before) {
    const auto other = std::ranges::find(after, std::invoke(name, item), name);
    if (other == after.end())
      only_a(file + ": " + std::invoke(name, item));
    else
      compare(item, *other);
  }
}

}  // namespace poinsot::report
