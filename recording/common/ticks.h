/// Ticks of recordings' clocks.
#pragma once

namespace emscape::interop {

/// Times (s) of a recording that are so near are equal: the ticks of DIS are 1.7e-6 s.
constexpr double kTickRounding_s = 5e-6;

}  // namespace emscape::interop
