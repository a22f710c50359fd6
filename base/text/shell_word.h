#pragma once

#include <string>

namespace emscape {

/// A text as one word of a command line of sh: as it is if no character has a meaning there, else in single
/// quotes.
std::string shellWord(const std::string& text);

}  // namespace emscape
