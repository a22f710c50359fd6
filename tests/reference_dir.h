/// Where the reference figures lie that are not part of the repository.
#pragma once

#include <cstdlib>
#include <filesystem>
#include <string>

namespace emscape::test {

/// The folder named by the environment variable EMSCAPE_REFERENCE_DIR, else `shared` beside the checkout. A
/// test that needs a file below it skips by name where the file is absent.
inline std::filesystem::path referenceDir() {
  const char* named = std::getenv("EMSCAPE_REFERENCE_DIR");
  return named ? std::filesystem::path(named)
               : std::filesystem::path(EMSCAPE_SOURCE_DIR).parent_path() / "shared";
}

}  // namespace emscape::test
