/// Threads in a process that may start only a few, as by `ulimit -u` or the limit of a container.
#pragma once

namespace emscape {

/// Starts threads that end at once. @param count  at the same time, > 0
/// @return how many of them could be started
int startableThreads(int count);

/// For libraries that end the program where they cannot start a thread.
/// @throws std::system_error (resource_unavailable_try_again) if fewer than `count` threads can be started
/// within a second, in which those that have done their work end
void requireThreads(int count);

/// From now on no thread is started that only saves time: the jobs of a Worker with a bound run in push().
/// For the beginning of a program.
void spareThreads();
bool sparesThreads();

}  // namespace emscape
