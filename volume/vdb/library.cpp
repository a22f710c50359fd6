#include <utility>

#include "volume/format/vdb_functions.h"

using namespace emscape;

namespace {

/// A function as a part of its caller's work.
template <auto function>
struct PartOfWork;
template <class Result, class... Arguments, Result (*function)(Arguments...)>
struct PartOfWork<function> {
  static Result call(Work* work, Arguments... arguments) {
    const WorkScope scope(work);
    return function(std::forward<Arguments>(arguments)...);
  }
};

}  // namespace

extern "C" __attribute__((visibility("default"))) void EMSCAPE_VDB_ENTRY(volume::VdbFunctions& functions,
                                                                         const LogSink& log) {
  setLogSink(log);
  functions = {PartOfWork<volume::vdb::read>::call, PartOfWork<volume::vdb::describe>::call,
               PartOfWork<volume::vdb::write>::call, PartOfWork<volume::vdb::toNano>::call};
}
