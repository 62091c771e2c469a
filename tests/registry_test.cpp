// The table behind a choice by name: finding, refusing, adding.
#include "core/registry.h"

#include <gmock/gmock.h>

#include <array>

namespace poinsot {
namespace {

using ::testing::ElementsAre;

struct Fruit {
  std::string_view name;
  int pips = 0;
};
constexpr std::array kFruits{Fruit{"apple", 5}, Fruit{"cherry", 1}};

TEST(Registry, FindsByName) {
  const Registry<Fruit> fruits("fruit", kFruits);
  EXPECT_THAT(fruits.names(), ElementsAre("apple", "cherry"));
  ASSERT_NE(fruits.find("cherry"), nullptr);
  EXPECT_EQ(fruits.find("cherry")->pips, 1);
  EXPECT_EQ(fruits.require("apple").pips, 5);
  EXPECT_EQ(fruits.find("Apple"), nullptr);
}

TEST(Registry, SaysWhichThereAre) {
  const Registry<Fruit> fruits("fruit", kFruits);
  try {
    (void)fruits.require("pear");
    ADD_FAILURE() << "there is a pear";
  } catch (const InputError& error) {
    EXPECT_STREQ(error.what(), "fruit 'pear' is not known; there are apple, cherry");
  }
}

TEST(Registry, KeepsReferencesWhileItGrows) {
  static constexpr std::string_view kNames = "abcdefghijklmnopqrstuvwxyz";
  Registry<Fruit> fruits("fruit", kFruits);
  const Fruit& apple = fruits.require("apple");
  for (std::size_t k = 0; k < kNames.size(); ++k) fruits.add({kNames.substr(k, 1), static_cast<int>(k)});
  EXPECT_EQ(&apple, fruits.find("apple"));
  EXPECT_EQ(fruits.size(), kFruits.size() + kNames.size());
  EXPECT_EQ(fruits.back().pips, 25);
}

TEST(Registry, RefusesANameTwice) {
  Registry<Fruit> fruits("fruit", kFruits);
  EXPECT_THROW(fruits.add({"apple", 2}), std::logic_error);
  EXPECT_THROW(fruits.add({"", 2}), std::logic_error);
  EXPECT_EQ(fruits.size(), 2U);
}

}  // namespace
}  // namespace poinsot
