/// Builds with a sanitizer, which runs everything, but is no measure of time and memory.
#pragma once

namespace emscape::test {

/// True in a build with the address or the thread sanitizer. Such a build takes 5 to 30 times as long and
/// reserves terabytes of addresses: what a test asserts about times or limits of memory holds in others.
#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
constexpr bool kIsSanitized = true;
#else
constexpr bool kIsSanitized = false;
#endif

}  // namespace emscape::test
