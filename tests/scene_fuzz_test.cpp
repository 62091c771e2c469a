// Damaged scene files: whatever bytes come, the reader answers with a scene or with an InputError, never otherwise.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <fstream>
#include <random>
#include <vector>

#include "core/input_error.h"
#include "core/model.h"
#include "core/scene_reader.h"
#include "tests/scale.h"
#include "tests/support/simulation.h"

namespace poinsot {
namespace {

std::vector<std::string> model_texts() {
  std::vector<std::string> texts;
  for (const std::string& name : test::model_names()) {
    std::ifstream in(fmt::format("{}/models/{}.json", POINSOT_SOURCE_DIR, name), std::ios::binary);
    texts.emplace_back(std::istreambuf_iterator<char>(in), std::istreambuf_iterator<char>());
  }
  return texts;
}

// Pieces that put together are the text: strings, numbers and words, blanks, single marks.
std::vector<std::string> tokens(const std::string& text) {
  std::vector<std::string> tokens;
  const auto word = [](char c) {
    return std::isalnum(static_cast<unsigned char>(c)) || c == '-' || c == '+' || c == '.';
  };
  for (std::size_t k = 0; k < text.size();) {
    std::size_t end = k + 1;
    if (text[k] == '"') {
      while (end < text.size() && text[end - 1 + (end == k + 1)] != '"') ++end;
    } else if (word(text[k])) {
      while (end < text.size() && word(text[end])) ++end;
    }
    tokens.push_back(text.substr(k, end - k));
    k = end;
  }
  return tokens;
}

std::string mutate(const std::string& text, std::mt19937_64& random) {
  const auto below = [&](std::size_t n) { return std::uniform_int_distribution<std::size_t>(0, n - 1)(random); };
  static const std::string kExtremes[] = {"1e308",
                                          "-1e308",
                                          "1e-320",
                                          "1e999",
                                          "-0",
                                          "null",
                                          "true",
                                          "[]",
                                          "{}",
                                          "\"\"",
                                          "\"1/0\"",
                                          "\"t\"",
                                          "\"(\"",
                                          "\"ground\"",
                                          "\"\\u0000\"",
                                          "\"2^9^9\"",
                                          "9999999999999999999999"};
  std::string result = text;
  for (std::size_t count = 1 + below(3); count > 0 && !result.empty(); --count) {
    switch (below(7)) {
      case 0:  // a bit
        result[below(result.size())] ^= static_cast<char>(1U << below(8));
        break;
      case 1:  // a byte
        result[below(result.size())] = static_cast<char>(below(256));
        break;
      case 2: {  // a stretch goes
        const std::size_t at = below(result.size());
        result.erase(at, 1 + below(20));
        break;
      }
      case 3: {  // a stretch comes twice
        const std::size_t at = below(result.size());
        result.insert(below(result.size()), result.substr(at, 1 + below(200)));
        break;
      }
      case 4:  // the end is missing
        if (below(10) == 0) result.resize(below(result.size()));
        break;
      default: {  // two tokens change places, or one becomes something extreme
        std::vector<std::string> parts = tokens(result);
        const std::size_t at = below(parts.size());
        if (below(2) == 0) {
          std::swap(parts[at], parts[below(parts.size())]);
        } else {
          parts[at] = kExtremes[below(std::size(kExtremes))];
        }
        result.clear();
        for (const std::string& part : parts) result += part;
      }
    }
  }
  return result;
}

TEST(SceneFuzz, damaged_models_are_read_or_refused) {
  constexpr unsigned kSeed = 20240611;
  std::mt19937_64 random(kSeed);
  const std::vector<std::string> texts = model_texts();
  ASSERT_FALSE(texts.empty());
  int read = 0, refused = 0;
  for (const std::string& text : texts) {
    for (int k = 0; k < scaled(1500); ++k) {
      const std::string damaged = mutate(text, random);
      try {
        const Scene scene = parse_scene(damaged, "damaged.json");
        const Model model = compile(scene);
        for (const Row& row : model.rows) (void)row.f.at(0.5);
        ++read;
      } catch (const InputError&) {
        ++refused;
      } catch (const std::exception& error) {
        FAIL() << error.what() << "\nseed " << kSeed << ", mutation " << k << " of:\n" << damaged;
      }
    }
  }
  // Both ends are reached, or the mutations test nothing.
  EXPECT_GT(read, refused / 20);
  EXPECT_GT(refused, read / 20);
}

}  // namespace
}  // namespace poinsot
