/// Reference figures and elevation data.
#pragma once

#include <filesystem>
#include <optional>
#include <string>

namespace emscape::test {

/// Folder of the data that the repository does not hold: the environment variable EMSCAPE_REFERENCE_DIR, else
/// `shared` beside the checkout.
std::filesystem::path referenceDir();

/// A file or folder of tests/data, else of referenceDir(); nothing if neither holds it.
/// @param path  such as "reference/itm_p2p"
std::optional<std::string> referenceFile(const std::string& path);

/// Why a test that needs such a file is skipped; scripts/test counts the tests that say so.
std::string notInRepository(const std::string& path);

}  // namespace emscape::test
