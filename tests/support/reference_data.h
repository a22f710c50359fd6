/// Reference figures and elevation data.
#pragma once

#include <filesystem>
#include <optional>
#include <string>

namespace emscape::test {

/// Folder of the data that are not in the repository: the environment variable EMSCAPE_REFERENCE_DIR, else
/// `shared` beside the checkout.
std::filesystem::path referenceDir();

/// A file or folder of tests/data, else of referenceDir(); empty if neither contains it.
/// @param path  such as "reference/itm_p2p"
std::optional<std::string> referenceFile(const std::string& path);

/// The reason for skipping a test that needs such a file; scripts/test counts these tests.
std::string notInRepository(const std::string& path);

}  // namespace emscape::test
