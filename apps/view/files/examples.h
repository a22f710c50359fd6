/// The scenarios that come with the program.
#pragma once

#include <string>
#include <vector>

namespace emscape::view {

struct Example {
  std::string file;
  std::string text;  ///< its first sentence
};

/// The scenarios of the installed program, or of the source tree that it was built in; empty if neither is
/// there. Reads files.
std::vector<Example> findExamples();

}  // namespace emscape::view
