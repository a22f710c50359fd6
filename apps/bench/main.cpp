/// emscape-bench: benchmarks; started by `emscape bench`.
#include "apps/bench/bench.h"

int main(int argc, char** argv) {
  std::vector<std::string> words{"bench"};
  words.insert(words.end(), argv + 1, argv + argc);
  return emscape::app::runProgram(words, emscape::app::addBench);
}
