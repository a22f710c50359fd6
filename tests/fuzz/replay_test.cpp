// Replays findings of fuzzing, and reads valid and damaged files, with the fuzzed functions.
#include <gtest/gtest.h>

#include <cstdlib>
#include <random>

#include "tests/fuzz/document_changes.h"
#include "tests/fuzz/fuzz_target.h"
#include "tests/support/files.h"

namespace emscape::test {
namespace {

namespace fs = std::filesystem;

/// Damaged inputs per target, and a fifth of the changes of documents; EMSCAPE_DAMAGED_INPUTS overrides it.
int damagedInputs() {
  const char* const number = std::getenv("EMSCAPE_DAMAGED_INPUTS");
  return number == nullptr ? 60 : std::atoi(number);
}

class Fuzz : public testing::TestWithParam<std::string> {};

/// A seed with a few bytes changed, left out or repeated; from a fixed generator.
std::string damaged(std::string bytes, std::mt19937& random) {
  for (unsigned change = 0; change < 1 + random() % 3 && !bytes.empty(); ++change) {
    const std::size_t at = random() % bytes.size();
    const std::size_t length = std::min<std::size_t>(1 + random() % 16, bytes.size() - at);
    switch (random() % 4) {
      case 0:
        bytes[at] = static_cast<char>(random());
        break;
      case 1:
        bytes.erase(at, length);
        break;
      case 2:
        bytes.insert(at, bytes.substr(random() % bytes.size(), length));
        break;
      default:
        bytes.resize(at);
    }
  }
  return bytes;
}

TEST_P(Fuzz, SeedsAndDamagedOnesAreReadOrRefusedWithAnError) {
  const FuzzTarget& target = fuzzTarget(GetParam());
  const std::vector<std::string> seeds = target.seeds();
  ASSERT_FALSE(seeds.empty());
  for (const std::string& seed : seeds) {
    EXPECT_FALSE(seed.empty());
    EXPECT_NO_THROW(runFuzzInput(target, seed)) << seed;
  }
  std::mt19937 random(1);
  for (int n = 0; n < damagedInputs(); ++n) {
    const std::string input = damaged(seeds[random() % seeds.size()], random);
    ASSERT_NO_THROW(runFuzzInput(target, input)) << testing::PrintToString(input);
  }
}

TEST_P(Fuzz, DocumentsWithAChangedValueAreReadOrRefusedWithAnError) {
  const FuzzTarget& target = fuzzTarget(GetParam());
  std::vector<DocumentChanges> documents;
  std::size_t changes = 0;
  for (const std::string& seed : target.seeds()) {
    documents.emplace_back(seed);
    changes += documents.back().count();
  }
  // evenly spread over all of them
  const auto step = std::max<std::size_t>(1, changes / (5 * static_cast<std::size_t>(damagedInputs())));
  std::size_t first = 0;
  for (const DocumentChanges& document : documents) {
    for (; first < document.count(); first += step) {
      const std::string input = document.changed(first);
      ASSERT_NO_THROW(runFuzzInput(target, input)) << input;
    }
    first -= document.count();
  }
}

TEST_P(Fuzz, RegressionInputsAreReadOrRefused) {
  const fs::path folder = sourceFile("tests/fuzz/regressions/" + GetParam());
  if (!fs::exists(folder)) return;
  for (const auto& entry : fs::directory_iterator(folder))
    EXPECT_NO_THROW(runFuzzInput(fuzzTarget(GetParam()), readFile(entry.path()))) << entry.path();
}

std::vector<std::string> names() {
  std::vector<std::string> all;
  for (const FuzzTarget& target : fuzzTargets()) all.push_back(target.name);
  return all;
}

INSTANTIATE_TEST_SUITE_P(Targets, Fuzz, testing::ValuesIn(names()),
                         [](const auto& target) { return target.param; });

}  // namespace
}  // namespace emscape::test
