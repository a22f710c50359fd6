// Program of the targets for libFuzzer:
//   PROGRAM --list                   names of the targets
//   PROGRAM TARGET --seeds FOLDER    writes FOLDER/TARGET/seed-N and FOLDER/TARGET.dict
//   PROGRAM TARGET ARGUMENT...       libFuzzer, with its own arguments
// A quarter of the inputs of readers of documents have a value changed, not bytes.
#include <algorithm>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <exception>
#include <string>

#include "tests/fuzz/document_changes.h"
#include "tests/fuzz/fuzz_target.h"
#include "tests/support/files.h"

extern "C" std::size_t LLVMFuzzerMutate(std::uint8_t* data, std::size_t size, std::size_t max_size);

namespace {

using emscape::test::DocumentChanges;
using emscape::test::FuzzTarget;

const FuzzTarget* chosen = nullptr;

[[noreturn]] void list() {
  for (const FuzzTarget& target : emscape::test::fuzzTargets()) std::printf("%s\n", target.name.c_str());
  std::exit(0);
}

[[noreturn]] void writeSeeds(const std::filesystem::path& folder) {
  std::filesystem::create_directories(folder / chosen->name);
  int number = 0;
  for (const std::string& seed : chosen->seeds())
    emscape::test::writeFile(folder / chosen->name / ("seed-" + std::to_string(++number)), seed);
  emscape::test::writeFile(folder / (chosen->name + ".dict"), emscape::test::fuzzDictionary(*chosen));
  std::exit(0);
}

bool readsDocuments(const FuzzTarget& target) {
  const std::vector<std::string> seeds = target.seeds();
  return std::any_of(seeds.begin(), seeds.end(),
                     [](const std::string& seed) { return DocumentChanges(seed).count() > 0; });
}

}  // namespace

extern "C" int LLVMFuzzerInitialize(int* argc, char*** argv) {
  char** const words = *argv;
  if (*argc == 2 && std::string(words[1]) == "--list") list();
  if (*argc < 2) {
    std::fprintf(stderr, "usage: %s --list | TARGET --seeds FOLDER | TARGET ARGUMENT...\n", words[0]);
    std::exit(2);
  }
  try {
    chosen = &emscape::test::fuzzTarget(words[1]);
  } catch (const std::exception& error) {
    std::fprintf(stderr, "%s\n", error.what());
    std::exit(2);
  }
  if (*argc == 4 && std::string(words[2]) == "--seeds") writeSeeds(words[3]);
  for (int n = 1; n + 1 < *argc; ++n) words[n] = words[n + 1];
  words[--*argc] = nullptr;
  return 0;
}

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  emscape::test::runFuzzInput(*chosen, {reinterpret_cast<const char*>(data), size});
  return 0;
}

extern "C" std::size_t LLVMFuzzerCustomMutator(std::uint8_t* data, std::size_t size, std::size_t max_size,
                                               unsigned seed) {
  static const bool reads_documents = readsDocuments(*chosen);
  constexpr unsigned kOneIn = 4;
  if (reads_documents && seed % kOneIn == 0) {
    const DocumentChanges changes({reinterpret_cast<const char*>(data), size});
    if (changes.count() > 0) {
      const std::string changed = changes.changed(seed / kOneIn % changes.count());
      if (changed.size() <= max_size) {
        std::copy(changed.begin(), changed.end(), data);
        return changed.size();
      }
    }
  }
  return LLVMFuzzerMutate(data, size, max_size);
}
