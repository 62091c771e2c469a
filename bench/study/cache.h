// Results kept from run to run: a file per key, named by the key's hash, with the key beside the data.
//
// A file is taken only where its key is the one asked for (two keys of one hash are no wrong answer) and its checksum
// holds (a damaged file is none). It is written whole or not at all.
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace poinsot::study {

class Cache {
 public:
  // An empty folder keeps nothing. It is made when the first result is kept.
  explicit Cache(std::filesystem::path folder) : folder_(std::move(folder)) {}

  // What the user should know of (a damaged file, a folder that cannot be written) is added to `notices`.
  std::optional<std::string> find(std::string_view key, std::vector<std::string>& notices) const;
  void keep(std::string_view key, std::string_view data, std::vector<std::string>& notices) const;
  std::filesystem::path file(std::string_view key) const;

 private:
  std::filesystem::path folder_;
};

// $XDG_CACHE_HOME/poinsot or ~/.cache/poinsot; empty where the environment names neither.
std::filesystem::path user_cache();

std::uint64_t content_hash(std::string_view text);  // FNV-1a

// The program that computes, by content: version, commit, flags and a hash of the files the libraries' code stands in.
std::string program_identity();

}  // namespace poinsot::study
