/// Commands on a system without /proc.
#pragma once

#include <cstdlib>
#include <string>

namespace emscape::test {

/// The shell command with /proc hidden from it; empty if that cannot be done.
inline std::string withoutProc(const std::string& command) {
  const auto hidden = [](const std::string& shown) {
    return "unshare --mount sh -c 'mount -t tmpfs none /proc && " + shown + "'";
  };
  return std::system((hidden("true") + " 2>/dev/null").c_str()) == 0 ? hidden(command) : "";
}

}  // namespace emscape::test
