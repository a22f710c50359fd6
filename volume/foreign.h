/// Files that other programs wrote, or changed after Emscape wrote them; the same for all formats. Internal
/// to the module.
#pragma once

#include <exception>
#include <string>
#include <vector>

#include "emscape/base/error.h"

namespace emscape::volume {

/// Names of grids and arrays without a name.
constexpr char kUnnamedGrid[] = "density";
constexpr char kUnnamedArray[] = "scalars";

/// Warns that a grid or array has metadata of Emscape that do not describe it.
/// @param who  names it: "grid density"  @param why  "its voxels have another spacing than in its metadata"
void warnOfCopiedMetadata(const std::string& file, const std::string& who, const std::string& why);

/// Warns of the parts of a file that are not read, with the reason for each; a repeated call for a file does
/// not warn again.
void warnOfOmissions(const std::string& file, const std::vector<std::string>& reasons);

/// Index of the grid or array with a name. One without a name has the name `unnamed`.
/// @param kind  "grid" or "array"
/// @throws Error (bad_input), which lists the names, if there is none
std::size_t indexOfName(const std::vector<std::string>& names, const std::string& name, const char* unnamed,
                        const char* kind, const std::string& file);

/// The results of read(entry) for the entries of a file. Those that cannot be read are left out, with one
/// warning.
/// @param most      stops after this number of results
/// @param omission  another part of the file that is not read, for the warning; may be empty
/// @throws Error  of the first entry if none can be read; any that is not bad_input
template <class Entry, class Read>
auto readableOf(const std::string& file, const std::vector<Entry>& entries, std::size_t most,
                const Read& read, const std::string& omission = "") {
  std::vector<decltype(read(entries.front()))> results;
  std::vector<std::string> omissions;
  std::exception_ptr first_error;
  for (const Entry& entry : entries) {
    if (results.size() == most) break;
    try {
      results.push_back(read(entry));
    } catch (const Error& error) {
      if (error.code() != ErrorCode::bad_input) throw;
      if (!first_error) first_error = std::current_exception();
      omissions.push_back(error.message());
    }
  }
  if (results.empty() && first_error) std::rethrow_exception(first_error);
  if (!omission.empty()) omissions.push_back(omission);
  warnOfOmissions(file, omissions);
  return results;
}

}  // namespace emscape::volume
