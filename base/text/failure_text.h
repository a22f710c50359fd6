/// The text of an exception for the user.
#pragma once

#include <exception>
#include <filesystem>
#include <new>
#include <string>
#include <system_error>

#include "base/limits/address_limit.h"
#include "base/text/readable_text.h"

namespace emscape {

/// True if memory or threads are short.
inline bool isShortage(const std::exception& failure) {
  const auto* of_system = dynamic_cast<const std::system_error*>(&failure);
  return dynamic_cast<const std::bad_alloc*>(&failure) != nullptr ||
         std::string(failure.what()).find("pthread_create") != std::string::npos ||
         (of_system != nullptr && of_system->code() == std::errc::resource_unavailable_try_again);
}

/// what(), or a readable text for shortages and errors of the file system.
inline std::string failureText(const std::exception& failure) {
  const bool is_limited = hasAddressLimit();
  if (dynamic_cast<const std::bad_alloc*>(&failure) != nullptr)
    return std::string("out of memory") + (is_limited ? ": a limit on memory is reached (ulimit -v)" : "");
  if (const auto* of_files = dynamic_cast<const std::filesystem::filesystem_error*>(&failure))
    return readableText(of_files->path1().string() + ": " + of_files->code().message());
  if (!isShortage(failure)) return failure.what();
  return std::string("a thread or process cannot be started: ") +
         (is_limited ? "a limit on memory or processes is reached (ulimit -v, ulimit -u)"
                     : "a limit on processes is reached (ulimit -u, or of a container)");
}

}  // namespace emscape
