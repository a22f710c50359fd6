/// Fuzz targets: readers of files and texts, applied to arbitrary bytes.
#pragma once

#include <filesystem>
#include <functional>
#include <string>
#include <vector>

namespace emscape::test {

/// A reader. Each input is written into a file of a working folder and read from there.
struct FuzzTarget {
  std::string name;  ///< in lower case; also the folder of its seeds and regressions
  std::string file;  ///< name of the input in the working folder; empty: the text itself is read
  /// Reads the input. May throw Error, nothing else. @param bytes  contents of the file
  std::function<void(const std::filesystem::path& file, const std::string& bytes)> read;
  /// Valid inputs, made by the project's own writers or shipped with it.
  std::function<std::vector<std::string>()> seeds;
  /// Writes the files that the input refers to or is a part of; called once. May be empty.
  std::function<void(const std::filesystem::path& folder)> prepare = {};
  std::function<std::string()> vocabulary = {};  ///< a text of further words for the dictionary
};

/// All targets, by name.
const std::vector<FuzzTarget>& fuzzTargets();
/// @throws std::invalid_argument that lists the names
const FuzzTarget& fuzzTarget(const std::string& name);

/// Adds targets to the list, as a static object in the source file that defines them.
struct FuzzTargetsAdded {
  explicit FuzzTargetsAdded(std::vector<FuzzTarget> targets);
};

/// Reads an input and checks what the reader reports.
/// @throws std::logic_error for an unclear message (longer than 1000 characters, with control characters, or
/// in the words of a library), and for any exception of the reader other than Error
void runFuzzInput(const FuzzTarget& target, const std::string& bytes);

/// The check of runFuzzInput() for messages that are returned, not thrown.
void checkFuzzMessage(const std::string& message);

/// For FuzzTarget::prepare: copies the shipped scenarios and the files they name.
void copyScenarios(const std::filesystem::path& folder);

/// Words of the target's seeds and vocabulary, in the form of libFuzzer's dictionaries; at most 1000.
std::string fuzzDictionary(const FuzzTarget& target);

}  // namespace emscape::test
