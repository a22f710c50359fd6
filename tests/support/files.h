/// Files of the source tree, and whole files read and written.
#pragma once

#include <filesystem>
#include <string>

namespace emscape::test {

/// @param path  below the root of the source tree, such as "scenarios/quick.yaml"; $EMSCAPE_SOURCE_DIR is
/// another root,
///              for test programs that were copied to another machine
std::string sourceFile(const std::string& path);
/// scenarios/NAME of the source tree.
std::string shippedScenario(const std::string& name);

/// Contents of a file; empty if it cannot be read.
std::string readFile(const std::filesystem::path& file);
void writeFile(const std::filesystem::path& file, const std::string& text);

}  // namespace emscape::test
