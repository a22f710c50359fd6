/// The finished variants of an incomplete part.
#pragma once

#include <filesystem>
#include <map>
#include <set>
#include <string>
#include <vector>

#include "base/files/appended_file.h"
#include "study/sweep/study_runner.h"

namespace emscape::study {

/// A file to which each variant is appended when it is finished, so that none is lost if the process is
/// killed. Each line has a checksum; incomplete lines are ignored. Several processes may append to one file.
/// Appended lines survive the end of the process, but not a crash of the machine.
class PartJournal {
 public:
  /// Opens or creates the file and reads it.
  /// @param variants  of the part, in the plan's order; lines of other variants are ignored
  /// @throws Error (other) naming the file; (usage) for a file without any record that is not the beginning
  /// of one; (bad_input) with the line number, for a line that was changed, and for one with a valid checksum
  /// that is not a record of a variant
  PartJournal(std::filesystem::path file, std::vector<std::size_t> variants, std::size_t measures);

  /// The variants that are not finished, in the plan's order.
  std::vector<std::size_t> unfinished() const;
  /// Appends a variant.
  /// @param warnings  of the process so far  @param machine  backend and instruction set
  /// @throws Error (other) naming the file
  void add(VariantResult result, const std::set<std::string>& warnings, const std::string& machine);

  /// All variants of the part, in the plan's order. None may be unfinished.
  std::vector<VariantResult> results() const;
  const std::set<std::string>& warnings() const { return warnings_; }
  const std::set<std::string>& machines() const { return machines_; }

 private:
  void read(const std::string& text);

  std::filesystem::path file_;
  AppendedFile open_;
  std::vector<std::size_t> variants_;
  std::size_t measures_;
  std::map<std::size_t, VariantResult> finished_;
  std::set<std::string> warnings_, machines_;
  std::set<std::string> reported_;  ///< warnings that this process has appended
};

}  // namespace emscape::study
