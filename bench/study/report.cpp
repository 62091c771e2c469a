#include "bench/study/report.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <memory>

#include "bench/study/csv.h"
#include "bench/study/output_file.h"
#include "bench/study/output_place.h"
#include "core/check.h"
#include "core/provenance.h"

namespace poinsot::study {
namespace {
namespace fs = std::filesystem;

std::string markdown_row(const std::vector<std::string>& cells) {
  std::string row = "|";
  for (const std::string& cell : cells) {
    row += ' ';
    for (const char c : cell) row += c == '|' ? "\\|" : std::string(1, c);
    row += " |";
  }
  return row + "\n";
}

}  // namespace

std::vector<std::string> origin_lines(int core) {
  const Provenance& origin = provenance();
  std::vector<std::string> libraries;
  for (const Library& library : origin.libraries)
    libraries.push_back(fmt::format("{} {}", library.name, library.version));
  return {fmt::format("processor: {}, {}", processor(),
                      core < 0 ? "not pinned to a core" : "one thread pinned to one core"),
          fmt::format("program: poinsot {}, commit {}{}", origin.version, origin.commit,
                      origin.dirty ? ", with changes that are not in the commit" : ""),
          fmt::format("compiler: {} {} ({})", origin.compiler, origin.flags, origin.build_type),
          fmt::format("libraries: {}", fmt::join(libraries, ", "))};
}

std::string markdown(const Report& report) {
  std::string page = fmt::format("# {}\n\n{}\n", report.title, report.text);
  for (const Table& table : report.tables) {
    page += fmt::format("\n## {}\n\n", table.title);
    if (!table.text.empty()) page += table.text + "\n\n";
    page += markdown_row(table.header);
    page += markdown_row(std::vector<std::string>(table.header.size(), "---"));
    for (const auto& row : table.rows) page += markdown_row(row);
  }
  page += "\n---\n\n";
  for (const std::string& line : report.foot) page += fmt::format("- {}\n", line);
  return page;
}

std::string csv(const Table& table, const std::vector<std::string>& foot) {
  const auto line = [](const std::vector<std::string>& cells) {
    std::vector<std::string> fields;
    for (const std::string& cell : cells) fields.push_back(csv_field(cell));
    return fmt::format("{}\n", fmt::join(fields, ","));
  };
  std::string text = line(table.header);
  for (const auto& row : table.rows) text += line(row);
  for (const std::string& entry : foot) text += fmt::format("# {}\n", entry);
  return text;
}

void mark_incomplete(Report& report, std::string_view why) {
  report.text += fmt::format("\n\nIncomplete, {}: what was measured up to there.", why);
  report.foot.push_back(fmt::format("incomplete: {}", why));
}

fs::path interrupted_folder(const fs::path& directory) {
  return directory / "interrupted";
}

void remove_interrupted(const fs::path& directory, const std::vector<fs::path>& whole) {
  const fs::path folder = interrupted_folder(directory);
  std::error_code none;  // mostly there is nothing
  for (const fs::path& file : whole) fs::remove(folder / file.filename(), none);
  fs::remove(folder, none);  // not where it holds anything else
}

std::string kept_in(const fs::path& directory) {
  return fmt::format("; what was measured up to there is kept in {}", directory.string());
}

void make_folder(const fs::path& directory) {
  (void)make_folders(directory);
  const OutputFile attempt(directory / "tables.md");  // not committed: nothing remains of it
}

std::vector<fs::path> write_report(const Report& report, const fs::path& directory, std::string_view name) {
  std::vector<std::unique_ptr<OutputFile>> files;
  files.push_back(std::make_unique<OutputFile>(directory / fmt::format("{}.md", name)));
  files.back()->write(markdown(report));
  for (const Table& table : report.tables) {
    for (const auto& row : table.rows) check(row.size() == table.header.size(), "a table's rows match its header");
    files.push_back(std::make_unique<OutputFile>(directory / (table.file + ".csv")));
    files.back()->write(csv(table, report.foot));
  }
  for (const auto& file : files) file->complete();  // all or none
  std::vector<fs::path> written;
  for (const auto& file : files) {
    file->commit();
    written.push_back(file->target());
  }
  return written;
}

}  // namespace poinsot::study
