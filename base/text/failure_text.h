/// The text of an exception for the user.
#pragma once

#include <exception>
#include <filesystem>
#include <new>
#include <string>
#include <system_error>

#include "base/text/readable_text.h"

namespace emscape {

/// what(), or a readable text for std::bad_alloc and errors of the file system.
inline std::string failureText(const std::exception& failure) {
  if (dynamic_cast<const std::bad_alloc*>(&failure) != nullptr) return "out of memory";
  if (const auto* of_files = dynamic_cast<const std::filesystem::filesystem_error*>(&failure))
    return readableText(of_files->path1().string() + ": " + of_files->code().message());
  const std::string text = failure.what();
  const auto* of_system = dynamic_cast<const std::system_error*>(&failure);
  if (text.find("pthread_create") != std::string::npos ||
      (of_system != nullptr && of_system->code() == std::errc::resource_unavailable_try_again))
    return "a thread or process cannot be started: a limit on processes or memory is reached (ulimit -u, "
           "ulimit -v, or of a container)";
  return text;
}

}  // namespace emscape
