// Reports, timings and fits: numbers as text, in files, and lines through them.
#include <gmock/gmock.h>

#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <fstream>

#include "bench/study/csv.h"
#include "bench/study/fit.h"
#include "bench/study/measure.h"
#include "bench/study/output_file.h"
#include "bench/study/panels.h"
#include "bench/study/progress.h"
#include "bench/study/report.h"
#include "bench/study/scale_series.h"
#include "core/check.h"
#include "core/input_error.h"
#include "core/provenance.h"
#include "tests/support/simulation.h"

namespace poinsot::test {
namespace {
namespace fs = std::filesystem;
using testing::ElementsAre;
using testing::HasSubstr;

TEST(Fit, finds_the_line_that_is_there) {
  const std::vector<double> x{1, 2, 4, 7}, y{5, 7, 11, 17};
  const study::Line line = study::fit_line(x, y);
  EXPECT_NEAR(line.slope, 2, 1e-14);
  EXPECT_NEAR(line.intercept, 3, 1e-14);
}

TEST(Fit, is_the_one_of_least_squares) {
  const std::vector<double> x{0, 1, 2}, y{0, 3, 3};
  const study::Line line = study::fit_line(x, y);
  EXPECT_NEAR(line.slope, 1.5, 1e-15);
  EXPECT_NEAR(line.intercept, 0.5, 1e-15);
}

TEST(Fit, powers_with_the_exponents_between_neighbours) {
  const std::vector<double> x{1, 2, 4};
  const study::Power exact = study::fit_power(x, std::vector<double>{3, 24, 192});
  EXPECT_NEAR(exact.exponent, 3, 1e-13);
  EXPECT_NEAR(exact.neighbours.low, 3, 1e-13);
  const study::Power bent = study::fit_power(x, std::vector<double>{1, 2, 8});
  EXPECT_NEAR(bent.exponent, 1.5, 1e-13);
  EXPECT_NEAR(bent.neighbours.low, 1, 1e-13);
  EXPECT_NEAR(bent.neighbours.high, 2, 1e-13);
  EXPECT_EQ(bent.neighbours.text(1), "1.0 to 2.0");
  EXPECT_TRUE(study::Range().empty());
}

TEST(Timing, is_the_median_and_the_distance_of_the_quartiles) {
  const study::Timing odd = study::timing({5, 1, 3, 2, 4});
  EXPECT_EQ(odd.median, 3);
  EXPECT_NEAR(odd.spread, 2.0 / 3, 1e-15);
  EXPECT_EQ(study::timing({1, 2}).median, 1.5);
  EXPECT_EQ(study::timing({7}).spread, 0);
}

TEST(Measure, runs_every_cell_so_often_and_keeps_why_one_has_no_figures) {
  const Scene scene = scene_of("single_pendulum");
  Settings good = dynamics("rA", 1e-2, 0.1), wrong = good;
  wrong.formulation = "none";
  std::vector<study::Cell> cells{{"a", &scene, good, {}, {}, false}, {"b", &scene, wrong, {}, {}, false}};
  std::vector<std::size_t> order;
  std::vector<double> done;
  const study::ProgressCallback told = [&](const study::Progress& progress) {
    done.push_back(progress.done);
    EXPECT_EQ(progress.all, 8);
  };
  study::RunCounter counter(8, told);
  study::measure(cells, {3, true, [&](std::size_t k) {
                           order.push_back(k);
                           counter.next();
                         }});
  EXPECT_THAT(order, ElementsAre(0, 1, 0, 1, 0, 1, 0, 1));
  EXPECT_THAT(done, ElementsAre(0, 1, 2, 3, 4, 5, 6, 7));
  EXPECT_EQ(cells[0].runs.size(), 3u);
  EXPECT_EQ(cells[0].failure, "");
  EXPECT_EQ(cells[0].runs[0].steps, 10);
  EXPECT_TRUE(cells[1].runs.empty());
  EXPECT_THAT(cells[1].failure, HasSubstr("none"));
  EXPECT_GE(study::iterations_per_step(cells[0]), 1);
  EXPECT_EQ(study::us_per_step(cells[1], study::total).median, 0);
}

study::Table small_table() {
  return {"small", "A table", "What it shows.", {"name", "number"}, {{"one, two", "1"}, {"a|b", "2"}, {"\"q\"", "3"}}};
}

TEST(Report, as_csv_quotes_what_has_to_be_and_carries_its_foot) {
  EXPECT_EQ(study::csv(small_table(), {"processor: x"}),
            "name,number\n\"one, two\",1\na|b,2\n\"\"\"q\"\"\",3\n# processor: x\n");
}

TEST(Report, as_a_page_holds_every_table) {
  const std::string page = study::markdown({"Title", "Text.", {small_table()}, {"processor: x"}});
  EXPECT_EQ(page,
            "# Title\n\nText.\n\n## A table\n\nWhat it shows.\n\n| name | number |\n| --- | --- |\n| one, two | 1 |\n"
            "| a\\|b | 2 |\n| \"q\" | 3 |\n\n---\n\n- processor: x\n");
}

TEST(Report, says_what_made_it) {
  const std::vector<std::string> lines = study::origin_lines(-1);
  EXPECT_THAT(lines, ElementsAre(AllOf(HasSubstr(processor()), HasSubstr("not pinned")), HasSubstr(provenance().commit),
                                 HasSubstr(provenance().compiler), HasSubstr("KLU")));
  EXPECT_THAT(study::origin_lines(1).front(), HasSubstr("one thread pinned to one core"));
}

class Written : public testing::Test {
 protected:
  Written() {
    std::string pattern = (fs::temp_directory_path() / "poinsot-report-XXXXXX").string();
    check(mkdtemp(pattern.data()), "a folder for the test");
    folder_ = pattern;
  }
  ~Written() override { fs::remove_all(folder_); }

  static std::string read(const fs::path& file) {
    std::ifstream in(file, std::ios::binary);
    return {std::istreambuf_iterator<char>(in), {}};
  }

  fs::path folder_;
};

TEST_F(Written, report_is_a_page_and_a_csv_for_each_table) {
  const fs::path out = folder_ / "new" / "folder";
  study::make_folder(out);
  EXPECT_TRUE(fs::is_empty(out));  // trying to write left nothing
  const study::Report report{"Title", "Text.", {small_table()}, {"foot"}};
  EXPECT_THAT(study::write_report(report, out, "page"), ElementsAre(out / "page.md", out / "small.csv"));
  EXPECT_EQ(read(out / "page.md"), study::markdown(report));
  EXPECT_EQ(read(out / "small.csv"), study::csv(small_table(), {"foot"}));
  std::ofstream(folder_ / "file") << "";
  EXPECT_THROW(study::make_folder(folder_ / "file" / "below"), InputError);
  EXPECT_THROW(study::make_folder(""), InputError);
}

TEST_F(Written, file_is_whole_or_as_it_was) {
  const fs::path file = folder_ / "result.csv";
  std::ofstream(file) << "before";
  {
    study::OutputFile out(file);
    out.write("half");
  }
  EXPECT_EQ(read(file), "before");
  study::OutputFile out(file);
  out.write(0.1);
  out.write_field("a,b");
  EXPECT_EQ(read(file), "before");
  out.commit();
  EXPECT_EQ(read(file), "0.10000000000000001,\"a,b\"");
  EXPECT_EQ(std::distance(fs::directory_iterator(folder_), {}), 1);
  EXPECT_THROW(study::OutputFile{folder_}, InputError);
}

TEST(CsvField, what_a_spreadsheet_would_compute_is_quoted) {
  for (const char* formula : {"=cmd|' /C calc'!A0", "@SUM(1)", "-1+2", "+x", "-x"})
    EXPECT_EQ(study::csv_field(formula), fmt::format("\"{}\"", formula));
  for (const char* plain : {"", "-", "-1.5", "+2e-3", "1", "rod.x", "a=b"}) EXPECT_EQ(study::csv_field(plain), plain);
  EXPECT_EQ(study::csv_field("a \"b\", c"), "\"a \"\"b\"\", c\"");
}

TEST(Panels, hold_every_point_and_how_to_draw_it) {
  study::PanelPlot plot{"plot", "Title", "x", "y"};
  plot.log_y = false;
  plot.curves = {{"left", "rA", "", {{1, 2, true}, {3, 4}}}};
  const study::Table points = study::points_table(plot);
  EXPECT_THAT(points.rows, ElementsAre(ElementsAre("left", "rA", "", "1", "2", "", "", "1"),
                                       ElementsAre("left", "rA", "", "3", "4", "", "", "0")));
  EXPECT_THAT(study::layout_notes(plot),
              testing::IsSupersetOf({"title: Title", "x scale: log", "y scale: linear", "joined: yes"}));
}

// One structure whose step costs N^1.25 beyond what a body costs, with a size that failed and one left out.
TEST(Scale, growth_is_fitted_to_the_sizes_that_have_figures) {
  study::Series series{&scene_generators().front(), {}, {1, 10, 100, 1000, 10000, 100000}, {}};
  for (const int bodies : {1, 10, 100, 1000}) {
    study::IsolatedRun run;
    run.bodies = bodies;
    run.us_per_body = run.assembly = run.factor = run.solve = run.rest = std::pow(bodies, 0.25);
    run.start = bodies * 1e-6;
    run.kilobytes_per_body = 10;
    series.runs.push_back({run, run, run});
  }
  study::IsolatedRun failed, left_out;
  failed.failure = "out of memory";
  left_out.failure = "left out, 10000 bodies took 100 s";
  series.runs.push_back({failed});
  series.runs.push_back({left_out});

  const study::Table costs = study::cost_table({series});
  EXPECT_EQ(costs.rows.size(), 4u);
  const study::Table growth = study::growth_table({series});
  ASSERT_EQ(growth.rows.size(), 1u);
  EXPECT_EQ(growth.rows[0][3], "1.250");                                        // of the whole step
  EXPECT_EQ(growth.rows[0][8], "-");                                            // memory: one size alone
  EXPECT_EQ(growth.rows[0][9], "1.000");                                        // start-up
  EXPECT_EQ(growth.rows[0].back(), fmt::format("{:.2f}", std::pow(10, 0.25)));  // 1000 over 100 bodies
  const std::vector<study::Missing> missing = study::missing({series});
  ASSERT_EQ(missing.size(), 2u);
  EXPECT_TRUE(missing[0].failed);
  EXPECT_THAT(missing[0].why, HasSubstr("of 10000 bodies, rA, auto: out of memory"));
  EXPECT_FALSE(missing[1].failed);
}

}  // namespace
}  // namespace poinsot::test
