// Program of the targets for libFuzzer:
//   PROGRAM --list                   names of the targets
//   PROGRAM TARGET --seeds FOLDER    writes FOLDER/TARGET/seed-N and FOLDER/TARGET.dict
//   PROGRAM TARGET ARGUMENT...       libFuzzer, with its own arguments
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <exception>
#include <string>

#include "tests/fuzz/fuzz_target.h"
#include "tests/support/files.h"

namespace {

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
