// Reading, writing and conversion by OpenVDB, whose library is loaded at the first use.
#include <system_error>

#include "base/loaded_library.h"
#include "base/memory.h"
#include "base/text/failure_text.h"
#include "base/threads.h"
#include "emscape/base/error.h"
#include "volume/format/vdb.h"
#include "volume/format/vdb_functions.h"
#include "volume/nvdb/nanovdb_grid.h"

#define EMSCAPE_TEXT_OF(name) #name
#define EMSCAPE_TEXT(name) EMSCAPE_TEXT_OF(name)

namespace emscape::volume {
namespace {

void forwardLog(LogLevel level, const std::string& message) {
  switch (level) {
    case LogLevel::debug:
      return logDebug(message);
    case LogLevel::info:
      return logInfo(message);
    case LogLevel::warning:
      return logWarning(message);
  }
}

/// OpenVDB's library for logging starts threads when it is loaded, and ends the program if it cannot.
void requireThreadsOfOpenVdb() {
  try {
    requireThreads(4);
  } catch (const std::system_error& error) {
    throw Error(ErrorCode::other, "OpenVDB, which .vdb and .nvdb files need: " + failureText(error) +
                                      "; the formats vti and raw do without");
  }
}

const VdbFunctions& vdbFunctions() {
  static const VdbFunctions kFunctions = [] {
    requireMemory({"OpenVDB's library for .vdb and .nvdb files", std::size_t{96} << 20,
                   "the formats vti and raw do without"},
                  {});
    requireThreadsOfOpenVdb();
    const LoadedLibrary library({"emscape_vdb.so"}, "emscape_vdb.so, which .vdb and .nvdb files need",
                                "it is in ../lib/emscape beside the program's folder and needs the package "
                                "libopenvdb10.0 (Debian 12)");
    VdbFunctions functions{};
    reinterpret_cast<VdbEntry*>(library.function(EMSCAPE_TEXT(EMSCAPE_VDB_ENTRY)))(functions, forwardLog);
    return functions;
  }();
  return kFunctions;
}

}  // namespace

void requireVdb() {
  vdbFunctions();
}

DenseVolume readVdb(const std::filesystem::path& path, const std::string& grid_name) {
  return vdbFunctions().read(currentWork(), path, grid_name);
}

std::vector<DenseVolume> describeVdb(const std::filesystem::path& path) {
  return vdbFunctions().describe(currentWork(), path);
}

void writeVdb(const std::filesystem::path& path, const std::vector<const DenseVolume*>& volumes) {
  vdbFunctions().write(currentWork(), path, volumes);
}

nano::Handle toNano(const DenseVolume& volume, const SourceLocation& location) {
  return vdbFunctions().toNano(currentWork(), volume, location);
}

}  // namespace emscape::volume
