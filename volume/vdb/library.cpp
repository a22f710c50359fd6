#include "volume/format/vdb_functions.h"

using namespace emscape;

extern "C" __attribute__((visibility("default"))) void EMSCAPE_VDB_ENTRY(volume::VdbFunctions& functions,
                                                                         const LogSink& log) {
  setLogSink(log);
  functions = {volume::vdb::read, volume::vdb::describe, volume::vdb::write, volume::vdb::toNano};
}
