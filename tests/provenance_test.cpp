#include "core/provenance.h"

#include <gmock/gmock.h>

#include <cstdio>
#include <memory>
#include <string>

#include "core/blas.h"

namespace poinsot {
namespace {

using testing::AnyOf;
using testing::ContainsRegex;
using testing::Eq;
using testing::HasSubstr;
using testing::MatchesRegex;

std::string output_of(const std::string& command) {
  const std::unique_ptr<FILE, int (*)(FILE*)> pipe(popen(command.c_str(), "r"), pclose);
  std::string text;
  for (int c = 0; pipe && (c = std::fgetc(pipe.get())) != EOF;) text += static_cast<char>(c);
  return text;
}

TEST(Provenance, CommitIsTheCheckouts) {
  const std::string source = POINSOT_SOURCE_DIR;
  const std::string git = "git -c safe.directory=" + source + " -C " + source + " ";
  const bool checkout = output_of(git + "rev-parse --is-inside-work-tree --show-prefix 2>/dev/null") == "true\n\n";
  if (checkout) {
    EXPECT_THAT(provenance().commit, MatchesRegex("[0-9a-f]{40}"));
    EXPECT_EQ(output_of(git + "cat-file -t " + provenance().commit), "commit\n");
  } else {
    EXPECT_EQ(provenance().commit, "unknown");
    EXPECT_FALSE(provenance().dirty);
  }
}

TEST(Provenance, NamesCompilerFlagsAndLibraries) {
  const Provenance& p = provenance();
  EXPECT_THAT(p.version, MatchesRegex("[0-9]+\\.[0-9]+\\.[0-9]+"));
  EXPECT_THAT(p.compiler, MatchesRegex("[A-Za-z]+ [0-9.]+"));
  EXPECT_THAT(p.flags, HasSubstr("-std=c++20"));
#ifdef NDEBUG
  EXPECT_THAT(p.flags, HasSubstr("-DNDEBUG"));
#else
  EXPECT_THAT(p.flags, Not(HasSubstr("-DNDEBUG")));
#endif
  EXPECT_THAT(p.flags, Not(HasSubstr("fast-math")));
  EXPECT_FALSE(p.build_type.empty());
  for (const std::string name : {"Eigen", "SuiteSparse", "KLU", "nlohmann-json", "fmt", "CLI11"}) {
    SCOPED_TRACE(name);
    int found = 0;
    for (const Library& library : p.libraries) {
      if (library.name != name) continue;
      ++found;
      EXPECT_THAT(library.version, MatchesRegex("[0-9]+\\.[0-9]+\\.[0-9]+"));
    }
    EXPECT_EQ(found, 1);
  }
}

TEST(Provenance, ProcessorIsOneLine) {
  EXPECT_FALSE(processor().empty());
  EXPECT_THAT(processor(), Not(HasSubstr("\n")));
}

TEST(Blas, HasOneThreadOnceHeld) {
  hold_blas_to_one_thread();
  EXPECT_THAT(blas(), AnyOf(Eq("none"), Not(ContainsRegex(", [0-9]+ threads?$")), ContainsRegex(", 1 thread$")));
}

}  // namespace
}  // namespace poinsot
