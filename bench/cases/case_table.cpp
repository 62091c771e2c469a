#include "bench/cases/case_table.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <fmt/ranges.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <charconv>
#include <cstring>
#include <fstream>
#include <map>
#include <utility>

#include "bench/study/cache.h"
#include "bench/study/csv.h"
#include "bench/study/output_file.h"
#include "core/input_error.h"
#include "core/provenance.h"

namespace poinsot::cases {
namespace fs = std::filesystem;
using study::content_hash;
using study::csv_field;
namespace {

constexpr std::size_t kHex = 16;  // digits of a checksum and of a key
constexpr std::size_t kHead = 2 * kHex + 2;

// The first lines of a part. Times are those of one machine.
std::vector<std::string> notes(const Study& study) {
  const Provenance& origin = provenance();
  std::vector<std::string> lines{"# poinsot cases: 1",
                                 fmt::format("# program: {} {}{} {:016x}", origin.version, origin.commit,
                                             origin.dirty ? " modified" : "", content_hash(study::program_identity()))};
  if (study.timed()) lines.push_back(fmt::format("# timed on: {}", processor()));
  return lines;
}

std::uint64_t hex(std::string_view digits) {
  std::uint64_t value = 0;
  std::from_chars(digits.data(), digits.data() + digits.size(), value, 16);
  return value;
}

constexpr char kOk = ' ', kFailed = '!';  // after the key

std::size_t fields_in(std::string_view line) {
  std::size_t count = 1;
  bool quoted = false;
  for (const char c : line) {
    quoted ^= c == '"';
    count += c == ',' && !quoted;
  }
  return count;
}

// Whether the line, without its end, is a row; of which case.
bool is_row(std::string_view line, std::uint64_t& key, std::int64_t& number, bool& failed) {
  if (line.size() <= kHead || line[kHex] != ' ') return false;
  failed = line[2 * kHex + 1] == kFailed;
  if (hex(line.substr(0, kHex)) != content_hash(line.substr(kHex + 1))) return false;
  key = hex(line.substr(kHex + 1, kHex));
  return std::from_chars(line.data() + kHead, line.data() + line.size(), number).ec == std::errc();
}

// Lines of a file, with where they begin; a last one without its end is none.
class Lines {
 public:
  explicit Lines(const fs::path& file) : file_(file, std::ios::binary) {
    if (!file_) throw InputError(fmt::format("{}: cannot be read: {}", file.string(), std::strerror(errno)));
  }

  bool next(std::string& line) {
    offset_ = end_;
    torn_ = std::getline(file_, line) && file_.eof();
    if (!file_ || torn_) return false;
    end_ += line.size() + 1;
    return true;
  }
  std::uint64_t offset() const { return offset_; }  // of the line
  std::uint64_t end() const { return end_; }        // of the last complete one
  bool torn() const { return torn_; }

 private:
  std::ifstream file_;
  std::uint64_t offset_ = 0, end_ = 0;
  bool torn_ = false;
};

}  // namespace

CaseRow make_row(const Study& study, const Case& one, const std::string& fields, bool failed) {
  const std::string rest =
      fmt::format("{:016x}{}{},{}", key_of(study, one), failed ? kFailed : kOk, one.number, fields);
  return {one.number, fmt::format("{:016x} {}\n", content_hash(rest), rest), failed};
}

std::string header(const Study& study) {
  std::string line = "case,scene,bodies";
  for (const std::vector<std::string>& names :
       {parameter_names(study), study.settings_varied, {"status"}, study.kept.columns(), {"message"}})
    for (const std::string& name : names) line += "," + csv_field(name);
  return line;
}

CaseTable::CaseTable(const Study& study) : study_(study), places_(static_cast<std::size_t>(study.size()), kNone) {}

CaseTable::~CaseTable() {
  for (const Part& part : parts_) close(part.descriptor);
}

void CaseTable::place(std::int64_t number, std::size_t part, std::uint64_t offset, bool failed, bool once) {
  std::uint64_t& place = places_[static_cast<std::size_t>(number)];
  if (once && place != kNone)
    throw InputError(fmt::format("case {} stands in {} and in {}; expected each shard once", number,
                                 parts_[place >> kPartShift].file.string(), parts_[part].file.string()));
  if (place != kNone) return;
  place = place_of(part, offset, failed);
}

std::int64_t CaseTable::failures(const Selection& selection) const {
  std::int64_t count = 0;
  for (std::int64_t k = 0; k < selection.size(); ++k) {
    const std::int64_t number = selection.at(k);
    count += has(number) && (places_[static_cast<std::size_t>(number)] >> kFailedShift & 1) != 0;
  }
  return count;
}

std::int64_t CaseTable::read(const fs::path& file, bool once) {
  Lines lines(file);
  std::string line;
  for (const std::string& note : notes(study_)) {
    if (!lines.next(line) || !line.starts_with(note.substr(0, note.find(':') + 1)))
      throw InputError(fmt::format("{}: is no part of a study; --fresh begins it anew", file.string()));
    if (line != note)
      throw InputError(
          fmt::format("{}: computed otherwise, there it says \"{}\", now \"{}\"; --fresh begins it anew, "
                      "another --out keeps it",
                      file.string(), line.substr(2), note.substr(2)));
  }
  const int descriptor = ::open(file.c_str(), O_RDONLY | O_CLOEXEC);
  if (descriptor < 0) throw InputError(fmt::format("{}: cannot be read: {}", file.string(), std::strerror(errno)));
  parts_.push_back({file, descriptor});
  const std::size_t part = parts_.size() - 1;
  std::int64_t taken = 0;
  const std::size_t fields = fields_in(header(study_));
  std::map<std::uint64_t, std::pair<std::uint64_t, bool>> elsewhere;  // by key: rows under other numbers
  while (lines.next(line)) {
    std::uint64_t key = 0;
    std::int64_t number = 0;
    bool failed = false;
    const bool row = is_row(line, key, number, failed), whole = row && fields_in(line.substr(kHead)) == fields;
    const bool own = row && number >= 0 && number < study_.size() && key == key_of(study_, case_of(study_, number));
    if (own && whole) {
      place(number, part, lines.offset(), failed, once);
      ++taken;
    } else if (!row || own) {
      ++damaged_;
    } else if (whole) {
      elsewhere.insert_or_assign(key, std::pair(lines.offset(), failed));
    } else {  // as the study was when it had other columns
      ++unused_;
    }
  }
  damaged_ += lines.torn();
  for (std::int64_t number = 0; number < study_.size() && !elsewhere.empty(); ++number) {
    if (has(number)) continue;
    const auto found = elsewhere.find(key_of(study_, case_of(study_, number)));
    if (found == elsewhere.end()) continue;
    place(number, part, found->second.first, found->second.second, once);
    elsewhere.erase(found);
    ++taken;
  }
  unused_ += static_cast<std::int64_t>(elsewhere.size());
  return taken;
}

void CaseTable::open(const fs::path& file) {
  const auto refuse = [&](const char* what) {
    throw InputError(fmt::format("{}: {}", file.string(), what ? what : std::strerror(errno)));
  };
  const int descriptor = ::open(file.c_str(), O_RDWR | O_CREAT | O_CLOEXEC, 0666);
  if (descriptor < 0) refuse(nullptr);
  parts_.push_back({file, descriptor});
  open_ = parts_.size() - 1;
  // Not every file system has locks; what has none is taken at its word.
  if (flock(descriptor, LOCK_EX | LOCK_NB) != 0 && errno == EWOULDBLOCK)
    refuse("another run of the study writes it; expected to be alone, or --shard with a place of its own");
  struct stat status {};
  if (fstat(descriptor, &status) != 0) refuse(nullptr);
  if (status.st_size == 0) {
    const std::string text = fmt::format("{}\n", fmt::join(notes(study_), "\n"));
    if (pwrite(descriptor, text.data(), text.size(), 0) != static_cast<ssize_t>(text.size())) refuse(nullptr);
    end_ = text.size();
    return;
  }
  Lines lines(file);
  for (std::string line; lines.next(line);) continue;
  end_ = lines.end();  // what was torn is overwritten
  if (ftruncate(descriptor, static_cast<off_t>(end_)) != 0) refuse(nullptr);
}

void CaseTable::add(const CaseRow& row) {
  const std::lock_guard lock(writing_);
  const Part& part = parts_[open_];
  const ssize_t written = pwrite(part.descriptor, row.line.data(), row.line.size(), static_cast<off_t>(end_));
  if (written != static_cast<ssize_t>(row.line.size())) {
    const std::string why = written < 0 ? std::strerror(errno) : "no space is left for a whole row";
    (void)!ftruncate(part.descriptor, static_cast<off_t>(end_));
    throw study::OutputError(
        fmt::format("{}: cannot be written: {}; what was computed is kept, the same command goes on with it",
                    part.file.string(), why));
  }
  places_[static_cast<std::size_t>(row.number)] = place_of(open_, end_, row.failed);
  end_ += row.line.size();
}

std::string CaseTable::fields(std::int64_t number) const {
  const std::uint64_t place = places_[static_cast<std::size_t>(number)];
  const Part& part = parts_[place >> kPartShift];
  auto offset = static_cast<off_t>((place & ((std::uint64_t{1} << kFailedShift) - 1)) + kHead);
  std::string text;
  char piece[512];
  for (ssize_t n = 0; (n = pread(part.descriptor, piece, sizeof piece, offset)) > 0; offset += n) {
    const std::string_view got(piece, static_cast<std::size_t>(n));
    const std::size_t end = got.find('\n');
    text += got.substr(0, end);
    if (end != got.npos) break;
  }
  return fmt::format("{}{}", number, text.substr(text.find(',')));  // under its number in this study
}

void CaseTable::write(const Selection& selection, const fs::path& csv) const {
  study::OutputFile file(csv);
  file.write(header(study_) + "\n");
  for (std::int64_t k = 0; k < selection.size(); ++k)
    if (const std::int64_t number = selection.at(k); has(number)) file.write(fields(number) + "\n");
  file.commit();
}

}  // namespace poinsot::cases
