#include "tests/support/reference_data.h"

#include <cstdlib>

#include "tests/support/files.h"

namespace emscape::test {

namespace fs = std::filesystem;

fs::path referenceDir() {
  const char* const folder = std::getenv("EMSCAPE_REFERENCE_DIR");
  return folder ? fs::path(folder) : fs::path(sourceFile("../shared"));
}

std::optional<std::string> referenceFile(const std::string& path) {
  for (const fs::path& file : {fs::path(sourceFile("tests/data")) / path, referenceDir() / path}) {
    if (fs::exists(file)) return file.string();
  }
  return std::nullopt;
}

std::string notInRepository(const std::string& path) {
  return "not in the repository: " + path;
}

}  // namespace emscape::test
