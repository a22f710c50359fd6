#include "tests/support/files.h"

#include <cstdlib>
#include <fstream>
#include <sstream>

namespace emscape::test {

std::string sourceFile(const std::string& path) {
  static const char* const other = std::getenv("EMSCAPE_SOURCE_DIR");
  return (other == nullptr ? EMSCAPE_SOURCE_DIR : other) + ("/" + path);
}

std::string shippedScenario(const std::string& name) {
  return sourceFile("scenarios/" + name);
}

std::string readFile(const std::filesystem::path& file) {
  std::ifstream in(file, std::ios::binary);
  std::ostringstream text;
  text << in.rdbuf();
  return text.str();
}

void writeFile(const std::filesystem::path& file, const std::string& text) {
  std::ofstream(file, std::ios::binary) << text;
}

}  // namespace emscape::test
