/// What an import has written, and what it could not use.
#pragma once

#include <string>

#include "emscape/interop/import_scenario.h"
#include "report/json.h"

namespace emscape::report {

Json importJson(const interop::ImportResult& result);
/// A table of objects by type and of emitters, the times, and what was lost, torn or ignored.
std::string importText(const interop::ImportResult& result);

}  // namespace emscape::report
