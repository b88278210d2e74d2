// SPDX-License-Identifier: MIT
// The kept corpora of the fuzzers through the same functions, whole and mutilated, with any compiler.

#include "chicane/base/random.hpp"
#include "fuzz/targets.hpp"
#include "support/chicane_test.hpp"

namespace chicane::fuzz {
namespace {

std::vector<std::string> corpus(std::string_view target) {
  std::vector<fs::path> files;
  for (const auto& item : fs::directory_iterator(fs::path(CHICANE_SOURCE_DIR) / "tests/fuzz/corpus" / target))
    files.push_back(item.path());
  std::sort(files.begin(), files.end());
  std::vector<std::string> all;
  for (const fs::path& file : files)
    all.push_back((std::ostringstream() << std::ifstream(file, std::ios::binary).rdbuf()).str());
  return all;
}

class Corpus : public ::testing::TestWithParam<Target> {};

TEST_P(Corpus, IsReadWithoutHarm) {
  const std::vector<std::string> inputs = corpus(GetParam().name);
  ASSERT_GE(inputs.size(), 3U) << GetParam().name;
  for (const std::string& input : inputs) GetParam().run(input);
  GetParam().run("");
}

TEST_P(Corpus, IsReadWithoutHarmWhenItIsMutilated) {
  Random random(23);
  const std::vector<std::string> inputs = corpus(GetParam().name);
  const auto below = [&](std::size_t count) {
    return static_cast<std::size_t>(random.uniform() * static_cast<double>(count));
  };
  constexpr int kRounds = 200;
  for (int round = 0; round < kRounds; ++round) {
    std::string text = inputs[below(inputs.size())];
    for (std::size_t change = 0; change <= below(3) && !text.empty(); ++change) {
      const std::size_t at = below(text.size());
      switch (below(4)) {
        case 0:
          text[at] = static_cast<char>(random.bits());
          break;
        case 1:
          text.resize(at);
          break;
        case 2:
          text.erase(at, 1 + below(20));
          break;
        default:
          text.insert(at, text.substr(at / 2, 40));
      }
    }
    GetParam().run(text);
  }
}

INSTANTIATE_TEST_SUITE_P(Targets, Corpus, ::testing::ValuesIn(targets().begin(), targets().end()),
                         [](const auto& parameter) { return std::string(parameter.param.name); });

}  // namespace
}  // namespace chicane::fuzz
