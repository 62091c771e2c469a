// A report of tables: one Markdown page, a CSV file beside it for each table, the same foot under all of them.
#pragma once

#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

namespace poinsot::study {

struct Table {
  std::string file;  // of the CSV, without extension
  std::string title;
  std::string text;  // what the table shows and what follows from it, one paragraph
  std::vector<std::string> header;
  std::vector<std::vector<std::string>> rows = {};  // as long as the header; the first columns are names
};

struct Report {
  std::string title, text;
  std::vector<Table> tables;
  std::vector<std::string> foot;  // machine, program, settings: a line each
};

// The first lines of a foot: processor, program, compiler, libraries. `core`: as pin_to_one_core() returns it.
std::vector<std::string> origin_lines(int core);

std::string markdown(const Report& report);
std::string csv(const Table& table, const std::vector<std::string>& foot);  // foot lines begin with '#'

// Says in the text and the foot that it holds only what was measured before an interruption: "interrupted by SIGINT".
void mark_incomplete(Report& report, std::string_view why);
// Where such a report goes: a whole one may stand in the folder from before.
std::filesystem::path interrupted_folder(const std::filesystem::path& directory);
// Once it is measured whole, what an interruption had left of these files is removed there, and the folder with the
// last.
void remove_interrupted(const std::filesystem::path& directory, const std::vector<std::filesystem::path>& whole);
// For the message that says so: "; what was measured up to there is kept in results/interrupted".
std::string kept_in(const std::filesystem::path& directory);

// Makes the folder and tries whether files can be written there. Throws InputError.
void make_folder(const std::filesystem::path& directory);

// DIR/NAME.md and DIR/TABLE.csv; returns the files. Throws InputError where they cannot be written.
std::vector<std::filesystem::path> write_report(const Report& report, const std::filesystem::path& directory,
                                                std::string_view name);

}  // namespace poinsot::study
