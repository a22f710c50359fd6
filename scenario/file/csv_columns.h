/// The columns of a CSV file, which tell what it holds.
#pragma once

#include <string>
#include <vector>

namespace emscape::scenario {

/// Names of the columns in the header of a file, which is searched for in its first 4096 bytes; none if the
/// file cannot be read or has no header.
std::vector<std::string> csvColumnsOf(const std::string& file);

}  // namespace emscape::scenario
