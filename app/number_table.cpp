#include "app/number_table.h"

#include <fmt/format.h>

#include <bit>
#include <fstream>

#include "core/input_error.h"

namespace poinsot::app {
using namespace study;

static_assert(std::endian::native == std::endian::little, "numbers are written as they lie in memory");

bool is_npy(const std::filesystem::path& file) {
  return file.extension() == ".npy";
}

NumberTable::NumberTable(const std::filesystem::path& file, const std::vector<std::string>& columns)
    : file_(file), npy_(is_npy(file)), columns_(columns.size()) {
  if (npy_) {
    if (is_device(file)) throw InputError(fmt::format("{}: an .npy file cannot be written to a device", file.string()));
    file_.write(npy_header());
    return;
  }
  file_.write(columns.front());
  for (std::size_t k = 1; k < columns.size(); ++k) file_.write_field(columns[k]);
  file_.write("\n");
}

void NumberTable::write(double value) {
  const bool first = column_ == 0, last = ++column_ == columns_;
  if (npy_) {
    file_.write(std::string_view(reinterpret_cast<const char*>(&value), sizeof value));
  } else {
    if (!first) file_.write(",");
    file_.write(value);
    if (last) file_.write("\n");
  }
  if (!last) return;
  column_ = 0;
  ++rows_;
}

void NumberTable::commit() {
  file_.commit();
  if (!npy_) return;
  std::fstream in_place(file_.target(), std::ios::in | std::ios::out | std::ios::binary);
  in_place << npy_header() << std::flush;
  if (!in_place) throw InputError(fmt::format("{}: its header cannot be written", file_.target().string()));
}

// Magic, version, length of the rest, and a Python dictionary padded with blanks: NumPy's numpy.lib.format.
std::string NumberTable::npy_header() const {
  constexpr std::size_t kBefore = 10;
  std::string text = fmt::format("{{'descr': '<f8', 'fortran_order': False, 'shape': ({}, {}), }}", rows_, columns_);
  text.resize(kNpyHeader - kBefore - 1, ' ');
  constexpr std::uint16_t kLength = kNpyHeader - kBefore;
  return fmt::format("\x93NUMPY{}{}{}{}{}\n", '\x01', '\0', static_cast<char>(kLength & 0xff),
                     static_cast<char>(kLength >> 8), text);
}

}  // namespace poinsot::app
