// A study: what is computed of which scenes with which settings, as a JSON file says it (models/study.schema.json,
// bench/cases/README.md).
//
// Its cases are all combinations of the scenes, the places along each parameter axis and the settings, in this order,
// the last varying fastest; a case is its number in it. File names are looked up beside the study. What is wrong is an
// InputError with file and key path, as in scenes.
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include "bench/cases/kept.h"
#include "bench/cases/pictures.h"
#include "bench/cases/variation.h"
#include "core/scene_reader.h"
#include "integrators/settings.h"

namespace poinsot::cases {

struct StudyScene {
  std::string name;
  Scene scene;
  std::vector<Column> columns;  // of the quantities kept
  std::uint64_t hash = 0;
};

struct SettingsChoice {
  Settings settings;
  std::vector<std::string> values;  // by setting that varies, as the table shows them
  std::uint64_t hash = 0;
  bool refused = false;  // no run can have them
};

struct Study {
  std::string name, about;
  std::vector<StudyScene> scenes;
  std::vector<ParameterAxis> axes;
  std::vector<std::string> settings_varied;  // keys
  std::vector<SettingsChoice> settings;      // all combinations
  int repetitions = 0;                       // timed runs of a case; 0: time is not measured
  Kept kept;
  std::vector<Picture> pictures;
  std::uint64_t columns_hash = 0;
  std::vector<std::string> notices;
  std::string content;  // JSON: the study and its scenes, in which no other file is needed

  bool timed() const { return repetitions > 0; }
  std::int64_t size() const;
};

struct Case {
  std::int64_t number = 0;
  std::size_t scene = 0, settings = 0;
  std::vector<double> parameters;  // by axis, by name
};
Case case_of(const Study& study, std::int64_t number);
std::vector<std::string> parameter_names(const Study& study);  // as Case::parameters
// Of scene, settings, parameters and what is kept: the same case of another study has the same key.
std::uint64_t key_of(const Study& study, const Case& one);

Study read_study(const std::filesystem::path& file);
// From what Study::content holds.
Study parse_content(std::string_view content);

}  // namespace poinsot::cases
