// The page of a folder of results: what it says of known numbers, that every number in it stands in a table beside it,
// and that no name becomes markup.
#include <fmt/format.h>
#include <fmt/ranges.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <regex>
#include <set>

#include "bench/report/compare.h"
#include "bench/report/figures.h"
#include "bench/report/findings.h"
#include "bench/report/html.h"
#include "bench/report/page.h"
#include "bench/report/ratios.h"
#include "bench/report/svg_panel.h"
#include "bench/study/motion.h"

namespace poinsot::report {
namespace {

using ::testing::HasSubstr;
using ::testing::Not;

constexpr int kRepetitions = 11;

// rp takes 1.5 times as long as rA, reps as long as it; with a hundredth of noise that both share.
study::CsvTable raw(double factor = 1) {
  study::CsvTable table{"raw",
                        {"analysis", "mechanism", "formulation", "jacobian", "linear_solver", "factored", "repetition",
                         "steps", "newton_iterations", "jacobian_evaluations", "factorizations", "solves", "total_s",
                         "assembly_s", "factor_s", "solve_s", "other_s"},
                        {},
                        {"processor: P", "program: poinsot", "compiler: C", "libraries: L", "settings: s"}};
  // rp three times: the second and third, beside other linear solvers, are not what ratios are of.
  for (const auto& [formulation, seconds] :
       {std::pair{"rA", 1e-3}, {"rp", 1.5e-3}, {"reps", 1e-3}, {"rp", 4e-3}, {"rp", 5e-3}})
    for (int r = 1; r <= kRepetitions; ++r) {
      const double t = factor * seconds * (1 + 0.01 * (r % 3));
      std::vector<std::string> row{"dynamics",           "four_link", formulation, "simplified", "auto", "klu, G",
                                   fmt::format("{}", r), "1000",      "3000",      "1000",       "1000", "3000"};
      for (const double x : {t, 0.25 * t, 0.25 * t, 0.25 * t, 0.25 * t}) row.push_back(fmt::format("{:.9f}", x));
      table.rows.push_back(row);
    }
  return table;
}

Results results(double factor = 1) {
  Results r{"results", {}};
  r.tables.emplace("raw", raw(factor));
  r.tables.emplace("constraint_counts",
                   study::CsvTable{"constraint_counts", {"mechanism", "CD"}, {{"<b>&\"", "3"}}, {}});
  return r;
}

TEST(Ratios, ArePairedAndKnowThePaper) {
  const std::vector<Ratio> all = ratios(raw());
  ASSERT_EQ(all.size(), 2u);
  EXPECT_EQ(all[0].formulation, "rp");
  EXPECT_NEAR(all[0].over.median, 1.5, 1e-6);
  EXPECT_NEAR(all[0].over.high - all[0].over.low, 0, 1e-5) << "noise that both share cancels";
  EXPECT_GT(all[0].over.confidence, 0.95);
  EXPECT_NEAR(all[0].saved[0], 0.25 * 0.5 * 1.01, 1e-2);
  EXPECT_DOUBLE_EQ(all[0].paper_c1, 2.62);
  EXPECT_DOUBLE_EQ(all[1].paper_c2, 2.41 / 1.44);
}

TEST(Findings, AreMadeOfTheNumbers) {
  const Findings found = findings(results());
  ASSERT_FALSE(found.all.empty());
  EXPECT_EQ(found.all[0].id, "like_for_like");
  EXPECT_THAT(found.all[0].sentences[0],
              HasSubstr("dynamics: rp takes 1.50 to 1.50 times as long as rA (medians of 1 mechanisms"));
  EXPECT_THAT(found.all[0].sentences[0], HasSubstr("In the paper: 2.41 to 2.62, more than any of these."));
  EXPECT_THAT(found.missing, ::testing::Contains(HasSubstr("poinsot chart --all")));
}

// One run, or two, do not know how much runs scatter.
TEST(Findings, OfFewRepetitionsDecideNothing) {
  struct Measured {
    double repetitions;
    const char *slower, *verdict;
  };
  for (const Measured& m : {Measured{1, "0", "leave it open"}, {2, "0", "leave it open"}, {5, "1", "It holds"}}) {
    Results r = results();
    std::erase_if(r.tables["raw"].rows,
                  [&](const auto& row) { return row[2] == "reps" || study::csv_number(row[6]) > m.repetitions; });
    const Findings found = findings(r);
    EXPECT_THAT(found.all[0].sentences[0], HasSubstr(fmt::format("slower beyond the noise in {} of them", m.slower)));
    const auto claims = std::ranges::find(found.all, "claims", &Finding::id);
    ASSERT_NE(claims, found.all.end());
    EXPECT_THAT(claims->sentences[0], HasSubstr(m.verdict)) << m.repetitions;
  }
}

// What is there is not called missing, whatever it says.
TEST(Findings, TellThatNoTimeIsSaved) {
  Results r = results();
  for (auto& row : r.tables["raw"].rows)
    if (row[2] == "rA")
      for (std::size_t c = 12; c < row.size(); ++c) row[c] = fmt::format("{:.9f}", 9 * study::csv_number(row[c]));
  const Findings found = findings(r);
  const auto own = std::ranges::find(found.all, "phases", &Finding::id);
  ASSERT_NE(own, found.all.end());
  EXPECT_EQ(own->sentences[0], "rA saves no time against rp in dynamics like for like, over all mechanisms.");
  EXPECT_THAT(found.missing, Not(::testing::Contains(HasSubstr("in which phase"))));
}

// rp is slower than rA beyond chance, reps is not; names of a study are no markup.
TEST(Findings, TellWhatStudiesOfFormulationsShow) {
  Results r = results();
  const study::CsvTable points{
      "speed_up", {"panel", "series", "variant", "x", "y", "low", "high"}, {{"", "rp", "", "1", "1.4", "", ""}}, {}};
  const study::CsvTable numbers{"speed_up_table",
                                {"formulation", "cases", "ratio", "from", "to"},
                                {{"rp", "50", "1.305", "1.243", "1.370"}, {"reps", "50", "1.011", "0.982", "1.041"}},
                                {}};
  r.studies.push_back({"random/",
                       "many <b>",
                       "about",
                       false,
                       true,
                       {{"time over that of rA", "speed_up", "formulation", "rA", points, numbers}}});
  const Findings found = findings(r);
  const auto own = std::ranges::find(found.all, "studies", &Finding::id);
  ASSERT_NE(own, found.all.end());
  EXPECT_THAT(own->sentences, ::testing::ElementsAre(
                                  "many <b>; time over that of rA: rp 1.305, 95 % interval 1.243 to 1.370 (geometric "
                                  "mean of 50 cases), above one beyond chance.",
                                  "many <b>; time over that of rA: reps 1.011, 95 % interval 0.982 to 1.041 "
                                  "(geometric mean of 50 cases), not to be told from one."));
  const std::string html = page(r).html;
  EXPECT_THAT(html, HasSubstr("<h3>many &lt;b&gt;</h3>"));
  EXPECT_THAT(html, HasSubstr("href=\"random/speed_up_table.csv\""));
  EXPECT_THAT(html, Not(HasSubstr("many <b>")));
  EXPECT_THAT(html, HasSubstr("Here a tenth of its cases (--quick)."));
  EXPECT_THAT(page(results()).html,
              HasSubstr("poinsot study bench/studies/random_mechanisms.json --out results/random_mechanisms"));
}

// Words with a digit, as tests/report/report_test.js would read them.
std::set<std::string> numbers(const std::string& text) {
  std::set<std::string> found;
  static const std::regex word(R"([\w.+\-−]*\d[\w.+\-]*)");
  for (std::sregex_iterator it(text.begin(), text.end(), word), end; it != end; ++it) {
    std::string token = it->str();
    while (!token.empty() && (token.back() == '.' || token.back() == '-')) token.pop_back();
    found.insert(token);
  }
  return found;
}

std::string visible(std::string html) {
  for (const char* pattern :
       {"<style>[^]*?</style>", "<script>[^]*?</script>", "<text class=\"tick\"[^>]*>[^<]*</text>", "<[^>]*>"})
    html = std::regex_replace(html, std::regex(pattern), " ");
  for (const auto& [code, text] :
       {std::pair{"&lt;", "<"}, {"&gt;", ">"}, {"&quot;", "\""}, {"&#39;", "'"}, {"&amp;", "&"}})
    for (std::size_t at; (at = html.find(code)) != std::string::npos;) html.replace(at, std::string(code).size(), text);
  return html;
}

TEST(Page, EveryNumberStandsInATable) {
  const Results r = results();
  const Page made = page(r);
  std::string all;
  for (const auto& [name, table] : r.tables) {
    all += fmt::format("{}\n{}\n", fmt::join(table.header, "\n"), fmt::join(table.notes, "\n"));
    for (const auto& row : table.rows) all += fmt::format("{}\n", fmt::join(row, "\n"));
  }
  for (const study::Table& table : made.tables) all += study::csv(table, made.foot);
  const std::set<std::string> known = numbers(all), shown = numbers(visible(made.html));
  EXPECT_GT(shown.size(), 20u);
  for (const std::string& number : shown) EXPECT_TRUE(known.contains(number)) << number << " stands in no table";
}

TEST(Page, TellsWhatIsIncompleteAndWhatFailed) {
  Results r = results();
  EXPECT_THAT(page(r).html, Not(HasSubstr("Incomplete")));
  r.tables["raw"].notes.push_back("incomplete: interrupted by <SIGINT>");
  r.studies.push_back({"sweep/", "sweep", "about", false, false, {}, 40, 7});
  const Page made = page(r);
  EXPECT_THAT(made.html, HasSubstr("Incomplete:"));
  EXPECT_THAT(made.html, HasSubstr("raw.csv</a>: interrupted by &lt;SIGINT&gt;"));
  EXPECT_THAT(made.html, HasSubstr("Of 40 cases 7 failed: numbers and pictures are of the others."));
  const auto studies = std::ranges::find(made.tables, "report_studies", &study::Table::file);
  ASSERT_NE(studies, made.tables.end());
  EXPECT_THAT(studies->rows, ::testing::ElementsAre(::testing::IsSupersetOf({"sweep", "40", "7"})));
}

TEST(Page, TellsWhatWasMadeWithQuick) {
  Results r = results();
  EXPECT_THAT(page(r).html, Not(HasSubstr("Made with --quick")));
  r.tables["raw"].notes.back() = "settings: s; --quick, a tenth";
  r.tables.emplace("order_paper", study::CsvTable{"order_paper", {"x"}, {{"1"}}, {"settings: --quick, fewer steps"}});
  r.studies.push_back({"sweep/", "sweep", "about", false, true, {}, 40, 0});
  EXPECT_THAT(page(r).html,
              HasSubstr("Made with --quick, in a reduced form: <a href=\"order_paper.csv\">order_paper.csv</a>, "
                        "<a href=\"raw.csv\">raw.csv</a>, <a href=\"sweep/cases.csv\">sweep/cases.csv</a></p>"));
}

TEST(Page, NoNameBecomesMarkup) {
  const std::string html = page(results()).html;
  EXPECT_THAT(html, HasSubstr("&lt;b&gt;&amp;&quot;"));
  EXPECT_THAT(html, Not(HasSubstr("<b>&")));
  EXPECT_EQ(link("a\"<b>.csv", "<"), "<a href=\"a%22%3Cb%3E.csv\">&lt;</a>");
}

TEST(Page, SaysWhatIsMissingAndHowToMakeIt) {
  const std::string html = page(results()).html;
  EXPECT_THAT(html,
              HasSubstr("Missing: energy.csv, energy_table.csv. <code>poinsot figures energy --out results</code>"));
  EXPECT_THAT(html, Not(HasSubstr("Missing: constraint_counts.csv")));
}

TEST(SvgPanel, DrawsNothingWhereALogarithmHasNoPlace) {
  SvgPanel panel;
  panel.curves.push_back({"a", 0, 0, {{0, 1}, {1, -1}}, {}, {}, false, false});
  EXPECT_EQ(svg(panel), "");
  panel.curves[0].points.push_back({1, 1, "<tip>", false});
  EXPECT_THAT(svg(panel), HasSubstr("<title>&lt;tip&gt;</title>"));
}

TEST(SvgPanel, ACloudOfPointsIsNotJoined) {
  study::CsvTable points{"p",
                         {"panel", "series", "variant", "x", "y", "low", "high"},
                         {{"", "rA", "", "1", "1.4", "", ""}, {"", "rA", "", "1", "1.7", "", ""}},
                         {"joined: yes"}};
  EXPECT_THAT(panels_html(points, "p"), HasSubstr("<path class=\"l\""));
  points.notes = {"joined: no"};
  EXPECT_THAT(panels_html(points, "p"), Not(HasSubstr("<path class=\"l\"")));
  EXPECT_THAT(panels_html(points, "p"), HasSubstr("<path class=\"m\""));
}

TEST(Compare, FindsATimeThatChangedAndOnlyThat) {
  EXPECT_TRUE(compare(results(), results()).same());
  const Comparison slower = compare(results(), results(1.1));
  EXPECT_EQ(slower.times, 5u);
  ASSERT_EQ(slower.changed_times.size(), 5u);
  EXPECT_NEAR(slower.changed_times[0].ratio.median, 1.1, 1e-5);
  EXPECT_NEAR(slower.common, 1.1, 1e-5);
  EXPECT_NEAR(slower.by_chance, 5 * 2.0 / 2048, 1e-12);
}

TEST(Compare, NoiseIsNoChange) {
  Results noisy = results();
  for (std::size_t k = 0; k < noisy.tables["raw"].rows.size(); ++k) {
    std::string& total = noisy.tables["raw"].rows[k][12];
    total = fmt::format("{:.9f}", study::csv_number(total) * (k % 2 ? 1.2 : 0.9));
  }
  EXPECT_TRUE(compare(results(), noisy).changed_times.empty());
}

TEST(Compare, TellsCountsAndWhatIsMissing) {
  Results other = results();
  other.tables["raw"].rows[0][8] = "2900";
  other.tables.erase("constraint_counts");
  std::erase_if(other.tables["raw"].rows, [](const auto& row) { return row[2] == "reps"; });
  const Comparison c = compare(results(), other);
  ASSERT_EQ(c.changed.size(), 1u);
  EXPECT_EQ(c.changed[0].quantity, "newton_iterations");
  EXPECT_EQ(c.changed[0].after, "2900");
  EXPECT_THAT(c.only_a,
              ::testing::ElementsAre("constraint_counts.csv", "raw.csv: dynamics, four_link, reps, simplified, auto"));
}

TEST(Compare, TellsWhatIsIncomplete) {
  Results other = results();
  other.tables["raw"].notes.push_back("incomplete: interrupted by SIGINT");
  const Comparison c = compare(results(), other);
  ASSERT_EQ(c.origins.size(), 1u);
  EXPECT_EQ(c.origins[0].key, "incomplete");
  EXPECT_EQ(c.origins[0].a, "");
  EXPECT_EQ(c.origins[0].b, "raw.csv");
}

// A chart of three cases and one that would have taken too long.
Results chart(double factor, double spread, const std::string& last = "left out, some 0.038 s are expected") {
  study::CsvTable table{"door", {"formulation", "integrator", "linear_solver", "parameter", "value", "status"}, {}, {}};
  for (const auto quantity : study::kQuantities) table.header.emplace_back(quantity);
  for (const char* column : {"violation_position", "violation_velocity", "energy_drift", "seconds", "spread", "steps",
                             "newton_iterations", "factorizations"})
    table.header.emplace_back(column);
  for (const auto quantity : study::kQuantities) table.header.push_back(fmt::format("front_{}", quantity));
  for (const auto& [step, seconds] : {std::pair{"0.01", 1.0}, {"0.005", 2.0}, {"0.0025", 4.0}, {"0.00125", 0.0}}) {
    std::vector<std::string> row{"rA", "rattle", "auto", "step", step, seconds > 0 ? "ok" : last};
    row.resize(table.header.size());
    for (std::size_t k = 0; k < study::kQuantities.size(); ++k) row[6 + k] = "1e-3";
    row[13] = fmt::format("{}", factor * seconds);
    row[14] = fmt::format("{}", seconds == 1.0 ? 10 * spread : spread);
    table.rows.push_back(row);
  }
  Results r{"results", {}};
  r.tables.emplace("door", std::move(table));
  return r;
}

// Spreads are those of one run: those of a few repetitions may be nothing, and one that was disturbed leaves a wide
// one.
TEST(Compare, TimesOfChartsChangeByMoreThanTheirSpreads) {
  const Comparison alike = compare(chart(1, 0.01), chart(1.09, 0));
  EXPECT_EQ(alike.times, 3u);
  EXPECT_TRUE(alike.same());
  const Comparison slower = compare(chart(1, 0.01), chart(1.3, 0.01));
  EXPECT_EQ(slower.changed_times.size(), 3u) << "the case with a wide spread among them";
  EXPECT_TRUE(compare(chart(1, 0.1), chart(1.3, 0.1)).changed_times.empty()) << "a noisy machine";
}

TEST(Compare, WhatAChartLeavesOutForItsTimeIsNoDifference) {
  EXPECT_TRUE(compare(chart(1, 0.01), chart(1, 0.01, "left out, some 0.039 s are expected")).same());
  const Comparison measured = compare(chart(1, 0.01), chart(1, 0.01, "ok"));
  EXPECT_TRUE(measured.same());
  EXPECT_THAT(measured.not_compared, ::testing::ElementsAre(HasSubstr("1 case: left out for the time")));
  EXPECT_FALSE(compare(chart(1, 0.01, "ok"), chart(1, 0.01, "the run stopped")).same());
}

TEST(Compare, DividesNoTimesOfTwoProcessorsOrCompilers) {
  for (const auto& [which, said] : {std::pair{std::size_t{0}, "another processor"}, {2, "another compiler or flags"}}) {
    Results other = results(2);
    other.tables["raw"].notes[which] += " of another make";
    const Comparison c = compare(results(), other);
    EXPECT_EQ(c.times, 0u);
    EXPECT_TRUE(c.changed_times.empty());
    ASSERT_EQ(c.not_compared.size(), 1u);
    EXPECT_THAT(c.not_compared[0], HasSubstr(said));
    EXPECT_EQ(c.origins.size(), 1u);
  }
  Results settings = results(2);
  settings.tables["raw"].notes[4] += "2";
  const Comparison c = compare(results(), settings);
  EXPECT_THAT(c.not_compared[0], HasSubstr("other settings"));
  EXPECT_FALSE(c.same()) << "what was not compared is not the same";
}

}  // namespace
}  // namespace poinsot::report
