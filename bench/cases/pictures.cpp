#include "bench/cases/pictures.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>

#include "bench/cases/kept.h"
#include "bench/cases/variation.h"

namespace poinsot::cases {
namespace {

std::string read_column(const JsonValue& place, const std::vector<std::string>& columns) {
  const std::string allowed = fmt::format("a column of the table: {}", fmt::join(columns, ", "));
  const std::string& name = place.string(allowed);
  if (std::ranges::find(columns, name) == columns.end()) place.expected(allowed);
  return name;
}

std::string optional_column(const JsonValue& object, std::string_view key, const std::vector<std::string>& columns) {
  const auto place = object.optional(key);
  return place ? read_column(*place, columns) : "";
}

Picture read_picture(const JsonValue& item, const std::vector<std::string>& columns, const Kept& kept) {
  item.keys("a picture", {"file", "title", "histogram", "bins", "points", "curves", "ratio", "log"});
  Picture picture;
  const JsonValue file = item.required("file");
  picture.file = picture.title = file.string("a file name without extension");
  const auto plain = [](char c) {
    return c == '_' || c == '-' || (c >= '0' && c <= '9') || ((c | 32) >= 'a' && (c | 32) <= 'z');
  };
  if (picture.file.empty() || !std::ranges::all_of(picture.file, plain) || picture.file == "cases")
    file.expected("letters, digits, _ and -, other than \"cases\"");
  if (const auto title = item.optional("title")) picture.title = title->string();
  if (const auto log = item.optional("log")) {
    constexpr std::string_view kAllowed = "\"x\", \"y\" or \"xy\"";
    const std::string& axes = log->string(kAllowed);
    if (axes != "x" && axes != "y" && axes != "xy") log->expected(kAllowed);
    picture.log_x = axes.starts_with('x');
    picture.log_y = axes.ends_with('y');
  }
  const auto read_axes = [&](const JsonValue& axes, const std::vector<std::string>& names) {
    axes.keys("axes", {"x", "y", "series"});
    const JsonValue x = axes.required("x"), y = axes.required("y");
    picture.x = read_column(x, names);
    picture.y = read_column(y, names);
    picture.series = optional_column(axes, "series", columns);
  };
  const auto histogram = item.optional("histogram"), points = item.optional("points"), curves = item.optional("curves"),
             ratio = item.optional("ratio");
  if (histogram.has_value() + points.has_value() + curves.has_value() + ratio.has_value() != 1)
    item.expected("one of \"histogram\", \"points\", \"curves\", \"ratio\"");
  if (const auto bins = item.optional("bins")) {
    if (!histogram) bins->fail("only a histogram has bins");
    picture.bins = static_cast<int>(read_count(*bins, 2, 10'000));
  }
  if (histogram) {
    picture.kind = Picture::histogram;
    picture.x = read_column(*histogram, columns);
    if (picture.bins == 0) picture.bins = 40;
  } else if (points) {
    picture.kind = Picture::points;
    read_axes(*points, columns);
  } else if (curves) {
    picture.kind = Picture::curves;
    std::vector<std::string> names;
    for (const Quantity& quantity : kept.quantities)
      if (!quantity.at.empty()) names.push_back(quantity.name);
    read_axes(*curves, names);
    const auto times = [&](const std::string& name) {
      return std::ranges::find(kept.quantities, name, &Quantity::name)->at;
    };
    if (times(picture.x) != times(picture.y)) curves->fail("x and y are kept at different times");
  } else {
    picture.kind = Picture::ratio;
    ratio->keys("a ratio", {"of", "by", "to", "over"});
    const JsonValue of = ratio->required("of"), by = ratio->required("by"), to = ratio->required("to");
    picture.y = read_column(of, columns);
    picture.by = read_column(by, columns);
    picture.to = to.string();
    const JsonValue over = ratio->required("over");
    picture.x = read_column(over, columns);
  }
  return picture;
}

}  // namespace

std::vector<Picture> read_pictures(const JsonValue& study, const std::vector<std::string>& columns, const Kept& kept) {
  std::vector<Picture> pictures;
  const auto list = study.optional("pictures");
  for (const JsonValue& item : list ? items(*list, "an array of pictures") : std::vector<JsonValue>()) {
    Picture picture = read_picture(item, columns, kept);
    if (std::ranges::find(pictures, picture.file, &Picture::file) != pictures.end())
      item.fail("two pictures of one file name, expected another");
    pictures.push_back(std::move(picture));
  }
  return pictures;
}

}  // namespace poinsot::cases
