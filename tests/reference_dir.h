/// Where the reference figures lie that are not part of the repository.
#pragma once

#include <cstdlib>
#include <filesystem>
#include <optional>
#include <string>

namespace emscape::test {

/// The folder named by the environment variable EMSCAPE_REFERENCE_DIR, else `shared` beside the checkout. A
/// test that needs a file below it skips by name where the file is absent.
inline std::filesystem::path referenceDir() {
  const char* named = std::getenv("EMSCAPE_REFERENCE_DIR");
  return named ? std::filesystem::path(named)
               : std::filesystem::path(EMSCAPE_SOURCE_DIR).parent_path() / "shared";
}

/// A file below it, or nothing if it is absent.
inline std::optional<std::string> referenceFile(const std::string& relative) {
  const std::filesystem::path file = referenceDir() / relative;
  if (!std::filesystem::exists(file)) return std::nullopt;
  return file.string();
}

}  // namespace emscape::test
