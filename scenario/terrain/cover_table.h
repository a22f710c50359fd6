/// Text of the class tables that come with the program: scenarios/data/land-cover, as they were at build
/// time.
#pragma once

namespace emscape::scenario {

/// By CoverTable.
extern const char* const kCoverTables[];

}  // namespace emscape::scenario
