#include "bench/records/number_table.h"

#include <fmt/format.h>

#include <bit>

#include "core/check.h"

namespace poinsot::records {
using namespace study;
namespace {

static_assert(std::endian::native == std::endian::little, "numbers are written as they lie in memory");

// Magic, version, length of the rest, and a Python dictionary padded with blanks: NumPy's numpy.lib.format.
std::string npy_header(std::int64_t rows, std::size_t columns) {
  constexpr std::size_t kBefore = 10;
  std::string text = fmt::format("{{'descr': '<f8', 'fortran_order': False, 'shape': ({}, {}), }}", rows, columns);
  text.resize(NumberTable::kNpyHeader - kBefore - 1, ' ');
  constexpr std::uint16_t kLength = NumberTable::kNpyHeader - kBefore;
  return fmt::format("\x93NUMPY{}{}{}{}{}\n", '\x01', '\0', static_cast<char>(kLength & 0xff),
                     static_cast<char>(kLength >> 8), text);
}

BinaryRows binary_rows(std::size_t columns) {
  return {NumberTable::kNpyHeader, columns * sizeof(double),
          [columns](std::int64_t rows) { return npy_header(rows, columns); }};
}

}  // namespace

bool is_npy(const std::filesystem::path& file) {
  return file.extension() == ".npy";
}

NumberTable::NumberTable(const std::filesystem::path& file)
    : file_(file, is_npy(file) ? Content::binary : Content::text), npy_(is_npy(file)) {}

NumberTable::NumberTable(const std::filesystem::path& file, std::vector<std::string> columns) : NumberTable(file) {
  begin(std::move(columns));
}

void NumberTable::begin(std::vector<std::string> columns) {
  check(!begun() && !columns.empty(), "a table is begun once, with its columns");
  columns_ = std::move(columns);
  if (npy_) {
    file_.set_rows(binary_rows(columns_.size()));
    file_.write(npy_header(0, columns_.size()));
    return;
  }
  file_.write(columns_.front());
  for (std::size_t k = 1; k < columns_.size(); ++k) file_.write_field(columns_[k]);
  file_.write("\n");
}

void NumberTable::write(double value) {
  const bool first = column_ == 0, last = ++column_ == columns_.size();
  if (npy_) {
    file_.write(std::string_view(reinterpret_cast<const char*>(&value), sizeof value));
  } else {
    if (!first) file_.write(",");
    file_.write(value);
    if (last) file_.write("\n");
  }
  if (last) column_ = 0;
}

}  // namespace poinsot::records
