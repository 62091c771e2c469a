// The page of `poinsot view`: what is in it, how large it is, what is refused. What it shows is looked at by
// view/view_test.js.
#include <fmt/format.h>

#include <cmath>

#include "bench/view/comparison.h"
#include "bench/view/page.h"
#include "bench/view/symbols.h"
#include "bench/view/trajectory_file.h"
#include "command_line.h"
#include "core/scene_reader.h"

namespace poinsot::test {
namespace {

class View : public CommandLine {
 protected:
  void SetUp() override {
    if (!view::missing_page().empty()) GTEST_SKIP() << view::missing_page();
    write("scene.json", kPendulum);
  }
  nlohmann::json data(const std::string& page) const {
    const std::string text = read(page), begin = "<script type=\"application/json\" id=\"data\">";
    const std::size_t from = text.find(begin) + begin.size();
    return nlohmann::json::parse(text.substr(from, text.find("</script>", from) - from));
  }
};

TEST_F(View, OneFileWithTheMotion) {
  const Result result = poinsot(
      {"view", "scene.json", "--integrator", "implicit_euler", "--end", "0.1", "--step", "0.01", "--out", "a.html"});
  EXPECT_EQ(result.status, 0) << result.err;
  EXPECT_EQ(files(), (std::vector<std::string>{"a.html", "scene.json"}));
  const nlohmann::json page = data("a.html");
  EXPECT_EQ(page["bodies"][0]["name"], "rod");
  EXPECT_EQ(page["motions"].size(), 1u);
  EXPECT_EQ(page["motions"][0]["t"].get<std::string>().size(), 4u * ((11 * 8 + 2) / 3));
  EXPECT_EQ(page["symbols"]["joints"][0]["type"], "revolute");
}

TEST_F(View, ATrajectoryIsShownAsItIs) {
  ASSERT_EQ(poinsot({"run", "scene.json", "--integrator", "implicit_euler", "--end", "0.1", "--step", "0.01", "--out",
                     "a.csv"})
                .status,
            0);
  ASSERT_EQ(poinsot({"view", "scene.json", "--trajectory", "a.csv", "--out", "read.html"}).status, 0);
  ASSERT_EQ(poinsot({"view", "scene.json", "--integrator", "implicit_euler", "--end", "0.1", "--step", "0.01", "--out",
                     "run.html"})
                .status,
            0);
  nlohmann::json read = data("read.html")["motions"][0], run = data("run.html")["motions"][0];
  EXPECT_EQ(read["label"], "a.csv");
  EXPECT_EQ(run["label"], "rA, implicit_euler, h = 0.01 s");
  EXPECT_EQ(read["t"], run["t"]);
  EXPECT_EQ(read["centres"], run["centres"]);
}

TEST_F(View, TwoMotionsAreCompared) {
  ASSERT_EQ(poinsot({"run", "scene.json", "--integrator", "implicit_euler", "--end", "0.1", "--step", "0.01", "--out",
                     "a.csv"})
                .status,
            0);
  ASSERT_EQ(poinsot({"run", "scene.json", "--integrator", "implicit_euler", "--end", "0.05", "--step", "0.01", "--out",
                     "b.csv"})
                .status,
            0);
  ASSERT_EQ(poinsot({"view", "scene.json", "--trajectory", "a.csv", "--trajectory", "b.csv", "--out", "c.html"}).status,
            0);
  const nlohmann::json page = data("c.html");
  EXPECT_EQ(page["motions"].size(), 2u);
  EXPECT_EQ(page["apart"], std::string(3 * 6 * 4 * 4 / 3, 'A'));  // six frames in common, the same in both
}

// Steps that error control chose are long, and what lies between is not said by the files.
TEST_F(View, MotionsOfOtherTimesAreAsFarApartEitherWay) {
  ASSERT_EQ(poinsot({"run", "scene.json", "--end", "0.5", "--out", "a.csv", "--quiet"}).status, 0);
  ASSERT_EQ(
      poinsot({"run", "scene.json", "--integrator", "rattle", "--end", "0.5", "--out", "b.csv", "--quiet"}).status, 0);
  const Scene scene = read_scene((folder() / "scene.json").string());
  const auto motion = [&](const char* file) {
    view::FrameRecorder recorder(std::make_shared<const Model>(compile(scene)), false);
    view::read_trajectory(folder() / file, scene,
                          [&](double t, std::span<const BodyState> bodies) { recorder.add(t, bodies); });
    return view::Motion{file, "", recorder.take()};
  };
  const auto largest = [](const std::vector<view::Apart>& all) {
    view::Apart most;
    for (const view::Apart& at : all) {
      most.position = std::max(most.position, at.position);
      most.angle = std::max(most.angle, at.angle);
    }
    return most;
  };
  const view::Motion a = motion("a.csv"), b = motion("b.csv");
  ASSERT_GT(b.frames.size(), 10 * a.frames.size());
  const view::Apart coarse = largest(view::apart(a, b)), fine = largest(view::apart(b, a));
  EXPECT_GT(coarse.position, 1e-8);
  EXPECT_NEAR(fine.position, coarse.position, 0.2 * coarse.position);
  EXPECT_NEAR(fine.angle, coarse.angle, 0.2 * coarse.angle);
}

// Its record tells that it is a part, or of other dimensions: a page that shows it says so.
TEST_F(View, ATrajectoryIsHeldAgainstItsRecord) {
  write("rod.json", R"({"scene": 1, "name": "rod", "gravity": [0, 0, -9.81], "parameters": {"l": 1},
    "bodies": [{"name": "rod", "mass": 3, "inertia": [1, 0.01, 1], "position": [0, "l", 0]}],
    "joints": [{"type": "revolute", "bodies": ["ground", "rod"], "point": [0, 0, 0], "axis": [1, 0, 0]}]})");
  ASSERT_EQ(poinsot({"run", "rod.json", "--set", "l=2", "--end", "0.1", "--out", "a.csv", "--quiet"}).status, 0);
  const auto viewed = [&](const std::vector<std::string>& more) {
    std::vector<std::string> arguments{"view", "rod.json", "--trajectory", "a.csv", "--out", "a.html"};
    arguments.insert(arguments.end(), more.begin(), more.end());
    const Result result = poinsot(arguments);
    EXPECT_EQ(result.status, 0);
    return result.err;
  };
  EXPECT_EQ(viewed({}),
            "poinsot: note: a.csv: computed with l = 2, not 1: it is drawn with the dimensions of rod.json\n");
  EXPECT_EQ(data("a.html")["motions"][0]["label"], "a.csv, computed with l = 2, not 1");
  EXPECT_EQ(viewed({"--set", "l=4/2"}), "");
  ASSERT_EQ(poinsot({"reference", "rod.json", "--set", "l=2", "--end", "0.1", "--digits", "4", "--out", "r.csv",
                     "--cache", "cache", "--quiet"})
                .status,
            0);
  EXPECT_EQ(poinsot({"view", "rod.json", "--trajectory", "r.csv", "--out", "a.html"}).err,
            "poinsot: note: r.csv: computed of a scene of other parameters: it is drawn with the dimensions of "
            "rod.json\n");
  std::string scene = read("rod.json");
  write("rod.json", scene.replace(scene.find("\"mass\": 3"), 9, "\"mass\": 4"));
  EXPECT_EQ(viewed({"--set", "l=2"}),
            "poinsot: note: a.csv: computed of a scene of other bodies: it is drawn with the dimensions of rod.json\n");

  write("over.json", kOverstretched);
  ASSERT_EQ(poinsot({"run", "over.json", "--integrator", "implicit_euler", "--end", "2", "--step", "0.01", "--out",
                     "over.csv", "--quiet"})
                .status,
            3);
  const Result part = poinsot({"view", "over.json", "--trajectory", "over.csv", "--out", "over.html"});
  EXPECT_EQ(part.status, 0);
  EXPECT_TRUE(part.err.starts_with("poinsot: note: over.csv: incomplete: ")) << part.err;
  EXPECT_EQ(data("over.html")["motions"][0]["message"], read_json("over.run.json")["message"]);
}

TEST_F(View, TenBodiesAndAThousandFramesAreBelowOneAndAHalfMegabytes) {
  ASSERT_EQ(poinsot({"make", "chain", "--bodies", "10", "--out", "chain.json"}).status, 0);
  ASSERT_EQ(poinsot({"view", "chain.json", "--integrator", "implicit_euler", "--end", "1", "--step", "0.001", "--out",
                     "a.html", "--quiet"})
                .status,
            0);
  EXPECT_EQ(data("a.html")["bodies"].size(), 10u);
  EXPECT_LT(read("a.html").size(), 1500000u);
}

TEST_F(View, NoNameEndsTheScript) {
  write("evil.json", R"({"scene": 1, "name": "</script><script>x()</script>", "bodies": [
    {"name": "<!--<script>\u2028'\"&", "mass": 1, "inertia": [1, 1, 1], "position": [0, 0, 0]}]})");
  ASSERT_EQ(poinsot({"view", "evil.json", "--integrator", "implicit_euler", "--end", "0.01", "--out", "a.html"}).status,
            0);
  EXPECT_EQ(data("a.html")["name"], "</script><script>x()</script>");
  EXPECT_EQ(data("a.html")["bodies"][0]["name"], "<!--<script>\u2028'\"&");
  ASSERT_EQ(
      poinsot({"view", "scene.json", "--integrator", "implicit_euler", "--end", "0.01", "--out", "b.html"}).status, 0);
  const auto scripts = [&](const std::string& page) {
    std::size_t count = 0;
    const std::string text = read(page);
    for (const std::string tag : {"<script", "</script", "<!--"})
      for (std::size_t at = 0; (at = text.find(tag, at)) != std::string::npos; ++at) ++count;
    return count;
  };
  EXPECT_EQ(scripts("a.html"), scripts("b.html"));
}

TEST_F(View, AFailedRunIsShownAsFarAsItCame) {
  write("over.json", kOverstretched);
  const Result result = poinsot(
      {"view", "over.json", "--integrator", "implicit_euler", "--end", "2", "--step", "0.01", "--out", "a.html"});
  EXPECT_EQ(result.status, 3);
  EXPECT_NE(data("a.html")["motions"][0]["message"], "");
}

TEST_F(View, WrongInputWritesNothing) {
  ASSERT_EQ(poinsot({"run", "scene.json", "--integrator", "implicit_euler", "--end", "0.02", "--step", "0.01", "--out",
                     "a.csv"})
                .status,
            0);
  write("none.csv", "t\n");
  write("empty.csv", "");
  write("a.npy", "\x93NUMPY\x01");
  write("number.csv", lines(read("a.csv"))[0] + "\n0,x\n");
  write("other.json", R"({"scene": 1, "name": "other", "bodies": [
    {"name": "ball", "mass": 1, "inertia": [1, 1, 1], "position": [0, 0, 0]}]})");
  write("conflicting.json", kConflicting);
  const auto before = files();
  const auto refused = [&](const std::vector<std::string>& arguments, const std::string& said) {
    const Result result = poinsot(arguments);
    EXPECT_EQ(result.status, 2);
    EXPECT_EQ(result.err, "poinsot: " + said + "\n");
    EXPECT_EQ(files(), before);
  };
  refused({"view", "scene.json", "--trajectory", "a.npy", "--out", "a.html"},
          "a.npy: found an array of NumPy, expected the CSV that `poinsot run --out FILE.csv` writes");
  refused({"view", "scene.json", "--trajectory", "nowhere.csv", "--out", "a.html"},
          "nowhere.csv: cannot be read: No such file or directory");
  refused({"view", "scene.json", "--trajectory", ".", "--out", "a.html"}, ".: found a directory, expected a file");
  refused({"view", "scene.json", "--trajectory", "empty.csv", "--out", "a.html"}, "empty.csv: the file is empty");
  refused({"view", "scene.json", "--trajectory", "none.csv", "--out", "a.html"},
          "none.csv: found 1 columns, expected \"rod.x\" next: not a trajectory of scene \"pendulum\"");
  refused({"view", "other.json", "--trajectory", "a.csv", "--out", "a.html"},
          "a.csv: column 2: found \"rod.x\", expected \"ball.x\": not a trajectory of scene \"other\"");
  refused({"view", "scene.json", "--trajectory", "number.csv", "--out", "a.html"},
          "number.csv: line 2: field 2: expected a number, 20 in all");
  refused({"view", "scene.json", "--trajectory", "a.csv", "--step", "0.1", "--out", "a.html"},
          "--step: expected nothing, a trajectory that is given is not computed");
  refused({"view", "scene.json", "--trajectory", "a.csv", "--out", "a.csv"},
          "a.csv: --out would overwrite --trajectory; choose another name or folder for the output");
  refused({"view", "conflicting.json", "--end", "0.1", "--out", "a.html"},
          "conflicting.json: the constraints conflict: with the others satisfied, constraint 'CD2' (/constraints/1, "
          "line 7) is "
          "still violated by 1 m/s (velocity); `poinsot check` names what it depends on");
}

TEST(ViewSymbols, ConstraintsThatMakeJointsAreDrawnAsJoints) {
  const auto types = [](const char* model) {
    std::string text;
    const view::Symbols all =
        view::symbols(compile(read_scene(fmt::format("{}/models/{}.json", POINSOT_SOURCE_DIR, model))));
    for (const view::JointSymbol& joint : all.joints) text += joint.type + " ";
    return text;
  };
  EXPECT_EQ(types("four_link"), "revolute revolute spherical universal ");
  EXPECT_EQ(types("four_link_joints"), "revolute universal spherical revolute ");
  EXPECT_EQ(types("slider_crank"), "revolute spherical translational ");
  EXPECT_EQ(types("knife_edge"), "");
}

TEST(ViewSymbols, BothBodiesHaveTheAxis) {
  for (const char* name : {"four_link", "slider_crank", "four_link_joints", "slider_crank_joints", "andrews"}) {
    const Model model = compile(read_scene(fmt::format("{}/models/{}.json", POINSOT_SOURCE_DIR, name)));
    for (const view::JointSymbol& joint : view::symbols(model).joints) {
      if (joint.type == "spherical" || joint.type == "universal") continue;
      const auto global = [&](int body, const Vector3& a) {
        return body == kGround ? a : Vector3(model.bodies[static_cast<std::size_t>(body)].orientation * a);
      };
      EXPECT_NEAR(std::abs(global(joint.i, joint.axis_i).dot(global(joint.j, joint.axis_j))), 1, 1e-4)
          << name << ' ' << joint.name;
    }
  }
}

}  // namespace
}  // namespace poinsot::test
