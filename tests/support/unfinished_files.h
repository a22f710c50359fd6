/// What a killed process leaves.
#pragma once

#include <signal.h>
#include <sys/wait.h>
#include <unistd.h>

#include <filesystem>
#include <stdexcept>

#include "base/files/unfinished_file.h"

namespace emscape::test {

/// Starts to write a file in a process of its own, and kills it.
inline void leaveUnfinished(const std::filesystem::path& file) {
  int ready[2];
  if (pipe(ready) != 0) throw std::runtime_error("no pipe");
  const pid_t process = fork();
  if (process == 0) {
    UnfinishedFile unfinished(file);
    unfinished.write([](std::ostream& stream) { stream << "half"; });
    close(ready[1]);
    for (;;) pause();
  }
  close(ready[1]);
  char byte = 0;
  if (read(ready[0], &byte, 1) != 0) throw std::runtime_error("no end of the pipe");
  kill(process, SIGKILL);
  waitpid(process, nullptr, 0);
  close(ready[0]);
}

}  // namespace emscape::test
