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

StudyResults read_one(const fs::path& folder, const std::string& record, const std::string& within) {
  using Json = nlohmann::json;
  StudyResults study{within, {}, {}, false, false, {}};
  try {
    constexpr bool kThrows = true, kComments = true;
    const Json json = Json::parse(read_text(record));
    const Json said = Json::parse(json.at("content").at("study").get<std::string>(), nullptr, kThrows, kComments);
    study.incomplete = json.at("incomplete");
    study.quick = json.at("quick");
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
  study::Table table{"report_studies", "Studies", "", {"study", "about", "picture", "file"}};
  for (const StudyResults& study : studies)
    for (const StudyPicture& picture : study.pictures)
      table.rows.push_back({study.name, study.about, picture.title, study.folder + picture.file + ".csv"});
  return table;
}

}  // namespace poinsot::report
