#include "bench/report/studies.h"

#include <fmt/format.h>

#include <algorithm>
#include <nlohmann/json.hpp>

#include "core/input_error.h"
#include "core/json_document.h"

namespace poinsot::report {
namespace fs = std::filesystem;
using study::read_csv;
namespace {

// As study::origin_lines() writes them below tables.
std::vector<std::string> origin_notes(const nlohmann::json& record) {
  const nlohmann::json& program = record.at("program");
  const auto text = [&](const char* key) { return program.at(key).get<std::string>(); };
  const bool pinned = record.contains("timing") && record["timing"].at("core") >= 0;
  return {fmt::format("processor: {}, {}", record.at("processor").get<std::string>(),
                      pinned ? "one thread pinned to one core" : "not pinned to a core"),
          fmt::format("program: poinsot {}, commit {}{}", text("version"), text("commit"),
                      program.at("dirty") ? ", with changes that are not in the commit" : ""),
          fmt::format("compiler: {} {} ({})", text("compiler"), text("flags"), text("build_type"))};
}

StudyResults read_one(const fs::path& folder, const std::string& record, const std::string& within) {
  using Json = nlohmann::json;
  StudyResults study{within, {}, {}, false, false, {}};
  try {
    constexpr bool kThrows = true, kComments = true;
    const Json json = Json::parse(read_text(record));
    const Json said = Json::parse(json.at("content").at("study").get<std::string>(), nullptr, kThrows, kComments);
    study.incomplete = json.at("incomplete");
    study.quick = json.at("quick");
    study.cases = json.at("cases").at("computed");
    study.failed = json.at("cases").at("failed");
    study.origin.notes = origin_notes(json);
    study.name = said.value("name", "");
    study.about = said.value("about", "");
    for (const Json& picture : said.value("pictures", Json::array())) {
      const std::string file = picture.at("file");
      const fs::path points = folder / (file + ".csv"), numbers = folder / (file + "_table.csv");
      if (fs::path(file).filename() != file || !fs::is_regular_file(points) || !fs::is_regular_file(numbers)) continue;
      const Json ratio = picture.value("ratio", Json::object());
      study.pictures.push_back({picture.value("title", file), file, ratio.value("by", ""), ratio.value("to", ""),
                                read_csv(points), read_csv(numbers)});
    }
  } catch (const Json::exception&) {
    throw InputError(fmt::format("{}: is no record of a study", record));
  }
  return study;
}

}  // namespace

std::vector<StudyResults> read_studies(const fs::path& folder) {
  std::vector<std::string> places{""};
  for (const auto& entry : fs::directory_iterator(folder))
    if (entry.is_directory()) places.push_back(entry.path().filename().string() + "/");
  std::ranges::sort(places);
  std::vector<StudyResults> all;
  for (const std::string& within : places)
    if (const fs::path record = folder / within / "cases.run.json"; fs::is_regular_file(record))
      all.push_back(read_one(folder / within, record.string(), within));
  return all;
}

study::Table studies_table(const std::vector<StudyResults>& studies) {
  study::Table table{"report_studies", "Studies", "", {"study", "about", "cases", "failed", "picture", "file"}};
  for (const StudyResults& study : studies) {
    const auto add = [&](const std::string& picture, const std::string& file) {
      table.rows.push_back({study.name, study.about, std::to_string(study.cases), std::to_string(study.failed), picture,
                            study.folder + file + ".csv"});
    };
    for (const StudyPicture& picture : study.pictures) add(picture.title, picture.file);
    if (study.pictures.empty()) add("", "cases");
  }
  return table;
}

}  // namespace poinsot::report
