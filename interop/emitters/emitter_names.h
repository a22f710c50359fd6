/// Names of emitters.
#pragma once

#include <map>
#include <string>

namespace emscape::interop {

/// The emitter names (UID 75) of SISO-REF-010.xml, by number. Nothing that the file refers to is opened.
/// @throws Error (bad_input): the file cannot be read, is no XML or has no such names
std::map<int, std::string> readEmitterNames(const std::string& file);

}  // namespace emscape::interop
