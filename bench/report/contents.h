// What stands in the page and where it comes from: the paper's tables and figures by its own numbers, then what the
// paper has not.
#pragma once

#include <span>
#include <string_view>

namespace poinsot::report {

struct Item {
  std::string_view number;  // in the paper, "Table 8"; empty: it has none
  std::string_view title;
  std::string_view figure;          // the table of its points, without extension; empty: none
  std::string_view tables[3] = {};  // files, without extension
  std::string_view command;         // that writes them
  std::string_view text = {};       // how to read it
};

struct Section {
  std::string_view id, title;
  std::span<const Item> items;
};

std::span<const Section> contents();

}  // namespace poinsot::report
