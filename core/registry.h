// The table behind a choice by name: the formulations, integrators, linear solvers and jacobians there are.
//
// Help texts, error messages, conformance tests and benchmarks are made from these tables. An entry is any type with a
// `name` that outlives the table. What the library brings stands in one list per table; a program may add entries of
// its own before it asks for anything else: formulations().add(...). References to entries stay good. Adding is not for
// several threads at a time.
#pragma once

#include <algorithm>
#include <deque>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "core/check.h"
#include "core/input_error.h"

namespace poinsot {

template <class Entry>
class Registry {
 public:
  using value_type = Entry;
  using const_iterator = typename std::deque<Entry>::const_iterator;

  // `key`: how messages call an entry, as the configuration does ("linear_solver").
  Registry(std::string_view key, std::span<const Entry> entries) : key_(key) {
    for (const Entry& entry : entries) add(entry);
  }
  Registry(const Registry&) = delete;
  Registry& operator=(const Registry&) = delete;

  void add(const Entry& entry) {
    check(!entry.name.empty() && !find(entry.name), "an entry of a registry has a name of its own");
    entries_.push_back(entry);
  }

  // nullptr where no entry has the name.
  const Entry* find(std::string_view name) const {
    const auto at = std::ranges::find(entries_, name, &Entry::name);
    return at == end() ? nullptr : &*at;
  }
  // Throws InputError where no entry has the name, and says which there are.
  const Entry& require(std::string_view name) const {
    if (const Entry* entry = find(name)) return *entry;
    std::string known;
    for (const Entry& entry : entries_) known += (known.empty() ? "" : ", ") + std::string(entry.name);
    throw InputError(std::string(key_) + " '" + std::string(name) + "' is not known; there are " + known);
  }
  std::vector<std::string> names() const {
    std::vector<std::string> names;
    for (const Entry& entry : entries_) names.emplace_back(entry.name);
    return names;
  }

  const_iterator begin() const { return entries_.begin(); }
  const_iterator end() const { return entries_.end(); }
  std::size_t size() const { return entries_.size(); }
  const Entry& front() const { return entries_.front(); }
  const Entry& back() const { return entries_.back(); }

 private:
  std::string_view key_;
  std::deque<Entry> entries_;  // keeps references where they are
};

}  // namespace poinsot
