#include "bench/study/cache.h"

#include <dlfcn.h>
#include <fmt/format.h>

#include <algorithm>
#include <cstdlib>
#include <fstream>
#include <set>

#include "bench/study/output_file.h"
#include "core/input_error.h"
#include "core/provenance.h"

namespace poinsot::study {
namespace fs = std::filesystem;
namespace {

constexpr std::uintmax_t kLargest = 4'000'000'000;  // bytes of a file that is read

// Empty where nothing can be read; only files are: a pipe would be waited for.
std::string content(const fs::path& file) {
  std::error_code none;
  if (!fs::is_regular_file(file, none)) return {};
  const std::uintmax_t size = fs::file_size(file, none);
  if (none || size > kLargest) return {};
  std::string text(size, '\0');
  std::ifstream in(file, std::ios::binary);
  in.read(text.data(), static_cast<std::streamsize>(size));
  text.resize(static_cast<std::size_t>(std::max<std::streamsize>(in.gcount(), 0)));
  return text;
}

// The file's first line; it vouches for the key and the data that follow.
std::string head(std::string_view key, std::string_view data) {
  return fmt::format("poinsot cache 1: checksum {:016x}, key of {} bytes, then the data\n",
                     content_hash(fmt::format("{}{}", key, data)), key.size());
}

// The file a function stands in: a shared library, or the program itself.
fs::path code_file(const void* function) {
  // Of a program that holds the library, dladdr tells how it was called, which is no path.
  Dl_info library{};
  const bool shared = dladdr(function, &library) != 0 && library.dli_fname &&
                      std::string_view(library.dli_fname).find(".so") != std::string_view::npos;
  return shared ? library.dli_fname : "/proc/self/exe";
}

}  // namespace

std::uint64_t content_hash(std::string_view text) {
  std::uint64_t hash = 14695981039346656037u;
  for (const char c : text) hash = (hash ^ static_cast<unsigned char>(c)) * 1099511628211u;
  return hash;
}

fs::path user_cache() {
  const auto named = [](const char* variable) -> fs::path {
    const char* value = std::getenv(variable);
    return value && *value ? value : "";
  };
  if (const fs::path base = named("XDG_CACHE_HOME"); base.is_absolute()) return base / "poinsot";
  const fs::path home = named("HOME");
  return home.empty() ? fs::path() : home / ".cache" / "poinsot";
}

std::string program_identity() {
  static const std::string identity = [] {  // megabytes are read for it
    const Provenance& origin = provenance();
    const std::set<fs::path> files{code_file(reinterpret_cast<const void*>(&provenance)),
                                   code_file(reinterpret_cast<const void*>(&program_identity))};
    std::string code;
    for (const fs::path& file : files) code += content(file);
    return fmt::format("poinsot {} {} {} {}, code {:016x}", origin.version, origin.commit, origin.compiler,
                       origin.flags, content_hash(code));
  }();
  return identity;
}

fs::path Cache::file(std::string_view key) const {
  return folder_ / fmt::format("{:016x}", content_hash(key));
}

std::optional<std::string> Cache::find(std::string_view key, std::vector<std::string>& notices) const {
  if (std::error_code none; folder_.empty() || !fs::exists(fs::symlink_status(file(key), none))) return {};
  std::string text = content(file(key));
  const std::size_t line = text.find('\n') + 1;
  const std::string_view rest = std::string_view(text).substr(line);
  if (rest.starts_with(key)) {
    std::string data(rest.substr(key.size()));
    if (text.substr(0, line) == head(key, data)) return data;
  }
  notices.push_back(fmt::format("{} is damaged or belongs to something else; what it should hold is computed again",
                                file(key).string()));
  return {};
}

void Cache::keep(std::string_view key, std::string_view data, std::vector<std::string>& notices) const {
  if (folder_.empty()) return;
  try {
    if (is_device(file(key))) throw InputError(fmt::format("{}: found no file, expected one", file(key).string()));
    OutputFile out(file(key));
    out.write(head(key, data));
    out.write(key);
    out.write(data);
    out.commit();
  } catch (const std::runtime_error& refused) {  // a folder or a disk that takes nothing
    notices.push_back(fmt::format("the result is not kept for the next time: {}", refused.what()));
  }
}

}  // namespace poinsot::study
