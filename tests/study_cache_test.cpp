// Results kept from run to run: what is found, what is not, and what a reference is kept by. As the user of the tests,
// and where that is root as nobody, too.
#include <gmock/gmock.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cstdlib>
#include <filesystem>
#include <fstream>

#include "bench/study/cache.h"
#include "bench/study/reference.h"
#include "tests/support/simulation.h"

namespace poinsot::test {
namespace {
namespace fs = std::filesystem;

class Kept : public testing::TestWithParam<const char*> {
 protected:
  Kept() {
    std::string pattern = (fs::temp_directory_path() / "poinsot-cache-XXXXXX").string();
    check(mkdtemp(pattern.data()), "a folder for the test");
    folder_ = pattern;
  }
  ~Kept() override {
    if (nobody_) check(seteuid(0) == 0 && setegid(0) == 0, "root again");
    fs::remove_all(folder_);
  }
  void SetUp() override {
    constexpr uid_t kNobody = 65534;
    if (std::string_view(GetParam()) != "nobody") return;
    if (geteuid() != 0) GTEST_SKIP() << "the tests are not run by root: as whom they run is tested";
    ASSERT_EQ(chown(folder_.c_str(), kNobody, kNobody), 0);
    nobody_ = true;
    ASSERT_TRUE(setegid(kNobody) == 0 && seteuid(kNobody) == 0);
  }

  study::Cache cache() const { return study::Cache(folder_ / "kept"); }
  std::size_t files() const {
    const auto all = fs::directory_iterator(folder_ / "kept");
    return static_cast<std::size_t>(std::distance(begin(all), end(all)));
  }

  fs::path folder_;
  std::vector<std::string> notices_;
  bool nobody_ = false;
};

TEST_P(Kept, what_was_kept_is_found) {
  EXPECT_EQ(cache().find("key", notices_), std::nullopt);
  cache().keep("key", "data\nof two lines", notices_);
  EXPECT_EQ(cache().find("key", notices_), "data\nof two lines");
  EXPECT_EQ(cache().find("other key", notices_), std::nullopt);
  cache().keep("key", "new", notices_);
  EXPECT_EQ(cache().find("key", notices_), "new");
  EXPECT_EQ(files(), 1u);
  EXPECT_TRUE(notices_.empty());
}

TEST_P(Kept, a_damaged_file_is_none_and_is_told) {
  cache().keep("key", "data", notices_);
  const fs::path file = cache().file("key");
  std::string text;
  std::getline(std::ifstream(file, std::ios::binary), text, '\0');
  for (const std::string& damaged : {std::string(), text.substr(0, text.size() - 1), text + "x", "x" + text,
                                     text.substr(0, text.size() - 4) + "dota"}) {
    std::ofstream(file, std::ios::binary | std::ios::trunc) << damaged;
    notices_.clear();
    EXPECT_EQ(cache().find("key", notices_), std::nullopt) << damaged;
    EXPECT_THAT(notices_, testing::ElementsAre(testing::HasSubstr("is damaged or belongs to something else")));
  }
}

TEST_P(Kept, a_file_of_another_key_is_none) {
  cache().keep("key", "data", notices_);
  fs::rename(cache().file("key"), cache().file("other key"));
  EXPECT_EQ(cache().find("other key", notices_), std::nullopt);
  EXPECT_EQ(notices_.size(), 1u);
}

TEST_P(Kept, what_is_no_file_is_not_waited_for) {
  fs::create_directories(folder_ / "kept");
  ASSERT_EQ(mkfifo(cache().file("key").c_str(), 0600), 0);
  EXPECT_EQ(cache().find("key", notices_), std::nullopt);
  cache().keep("key", "data", notices_);
  EXPECT_THAT(notices_, testing::ElementsAre(testing::HasSubstr("is damaged or belongs to something else"),
                                             testing::HasSubstr("found no file, expected one")));
}

// With the right key and checksum, as anybody can write them.
TEST_P(Kept, a_forged_reference_is_computed_again) {
  Scene scene;
  scene.name = "falling";
  scene.gravity = {0, 0, -9.81};
  Body& body = scene.bodies.emplace_back();
  body.name = "body";
  body.mass = 1;
  body.inertia = Vector3(1, 2, 3).asDiagonal();
  scene.source = "any text stands for it";
  const study::ReferenceSettings settings{1, 0.5, 6};
  const study::Reference right = study::reference(scene, settings, cache(), notices_);
  ASSERT_EQ(right.motion.t.size(), 3u);
  EXPECT_TRUE(notices_.empty());
  const std::string key = study::reference_key(scene, settings, study::program_identity());
  const std::string kept = cache().find(key, notices_).value();
  const auto with = [&](const std::string& part, const std::string& other) {
    std::string forged = kept;
    const std::size_t at = forged.find(part);
    check(at != std::string::npos, "the part is there");
    return forged.replace(at, part.size(), other);
  };
  for (const std::string& forged :
       {std::string(), std::string("{}"), std::string("[1, 2]"), with("\"given\":", "\"given\":7"),
        with("\"t\":[", "\"t\":[0.0,"), with("\"bodies\":[", "\"bodies\":[1.0,"),
        with("\"lambda\":[", "\"lambda\":[[],"), with("\"nearest\":", "\"nearest\":9")}) {
    cache().keep(key, forged, notices_);
    notices_.clear();
    const study::Reference again = study::reference(scene, settings, cache(), notices_);
    EXPECT_THAT(notices_, testing::ElementsAre(testing::HasSubstr("does not hold this reference"))) << forged;
    EXPECT_EQ(again.motion.bodies.back()[0].r.z(), right.motion.bodies.back()[0].r.z());
  }
}

TEST_P(Kept, without_a_folder_nothing_is_kept) {
  const study::Cache none("");
  none.keep("key", "data", notices_);
  EXPECT_EQ(none.find("key", notices_), std::nullopt);
  EXPECT_TRUE(notices_.empty());
}

TEST_P(Kept, a_folder_that_cannot_be_made_is_told) {
  std::ofstream(folder_ / "file") << "";
  study::Cache(folder_ / "file" / "kept").keep("key", "data", notices_);
  const auto told = testing::ElementsAre(testing::HasSubstr("the result is not kept for the next time"));
  EXPECT_THAT(notices_, told);
  if (geteuid() == 0) return;  // may write everywhere
  notices_.clear();
  fs::permissions(folder_, fs::perms(0555));
  cache().keep("key", "data", notices_);
  EXPECT_THAT(notices_, told);
  fs::permissions(folder_, fs::perms(0755));
}

TEST(ReferenceKey, differs_wherever_the_result_could) {
  const Scene scene = scene_of("single_pendulum"), other = scene_of("double_pendulum");
  const study::ReferenceSettings usual{1, 0.25, 8};
  const std::string key = study::reference_key(scene, usual, "program");
  EXPECT_EQ(key, study::reference_key(scene, {1, 0.25, 8}, "program"));
  EXPECT_NE(key, study::reference_key(scene, {1 + 1e-15, 0.25, 8}, "program"));
  EXPECT_NE(key, study::reference_key(scene, {1, 0.125, 8}, "program"));
  EXPECT_NE(key, study::reference_key(scene, {1, 0.25, 9}, "program"));
  EXPECT_NE(key, study::reference_key(scene, usual, "another program"));
  EXPECT_NE(key, study::reference_key(other, usual, "program"));
  EXPECT_EQ(study::program_identity(), study::program_identity());
  EXPECT_EQ(study::program_identity().find(fmt::format("{:016x}", study::content_hash(""))), std::string::npos)
      << "no code was read";
}

TEST_P(Kept, a_reference_is_computed_once) {
  const Scene scene = scene_of("single_pendulum_free");
  const study::ReferenceSettings settings{0.5, 0.25, 5};
  const study::Reference first = study::reference(scene, settings, cache(), notices_);
  ASSERT_GE(first.given, 0) << study::why_none(first);
  EXPECT_EQ(files(), 1u);

  // What is kept under the key is what is given back: the same in another place.
  const std::string key = study::reference_key(scene, settings, study::program_identity());
  const std::optional<std::string> data = cache().find(key, notices_);
  ASSERT_TRUE(data);
  std::string changed = *data;
  const std::string nearest = fmt::format("\"nearest\":{}", first.nearest);
  ASSERT_NE(changed.find(nearest), std::string::npos);
  changed.replace(changed.find(nearest), nearest.size(), "\"nearest\":-1");
  cache().keep(key, changed, notices_);
  const study::Reference second = study::reference(scene, settings, cache(), notices_);
  EXPECT_EQ(second.nearest, -1);
  EXPECT_EQ(second.motion.t, first.motion.t);
  EXPECT_EQ(second.motion.lambda, first.motion.lambda);
  for (std::size_t k = 0; k < first.motion.t.size(); ++k) {
    EXPECT_EQ(second.motion.bodies[k][0].r, first.motion.bodies[k][0].r);
    EXPECT_EQ(second.motion.bodies[k][0].A, first.motion.bodies[k][0].A);
    EXPECT_EQ(second.motion.bodies[k][0].wd, first.motion.bodies[k][0].wd);
  }

  // A damaged one is computed again, to the same digits.
  std::ofstream(cache().file(key), std::ios::app) << "x";
  EXPECT_EQ(study::reference(scene, settings, cache(), notices_).nearest, first.nearest);
  EXPECT_EQ(notices_.size(), 1u);
  (void)study::reference(scene, {0.5, 0.25, 6}, cache(), notices_);
  EXPECT_EQ(files(), 2u);
}

TEST_P(Kept, a_reference_of_a_scene_without_text_is_not) {
  Scene scene = scene_of("single_pendulum_free");
  scene.source.clear();
  EXPECT_GE(study::reference(scene, {0.5, 0.25, 5}, cache(), notices_).given, 0);
  EXPECT_FALSE(fs::exists(folder_ / "kept"));
}

INSTANTIATE_TEST_SUITE_P(As, Kept, testing::Values("tester", "nobody"));

}  // namespace
}  // namespace poinsot::test
