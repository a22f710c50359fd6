/// Whether threads can be started, for libraries that end the program where they cannot start theirs.
#pragma once

namespace emscape {

/// Starts threads that end at once. @param count  at the same time, > 0
/// @throws std::system_error (resource_unavailable_try_again) if one cannot be started
void requireThreads(int count);

}  // namespace emscape
