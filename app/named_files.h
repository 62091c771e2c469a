// The files a command reads and writes by name, and that none of them overwrites another.
#pragma once

#include <filesystem>
#include <initializer_list>
#include <string_view>

namespace poinsot::app {

struct NamedFile {
  std::string_view what;       // in messages: "the scene", "--out"
  std::filesystem::path path;  // empty: there is none
};

// FILE.run.json beside FILE.csv; none beside a device.
std::filesystem::path record_beside(const std::filesystem::path& file);

// Throws InputError where an output is an input or another output. Devices take several, a descriptor that stands open
// (the standard output) takes one.
void refuse_overwriting(std::initializer_list<NamedFile> inputs, std::initializer_list<NamedFile> outputs);

}  // namespace poinsot::app
