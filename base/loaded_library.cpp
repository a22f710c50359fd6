#include "base/loaded_library.h"

#include <dlfcn.h>
#include <unistd.h>

#include "emscape/base/error.h"

namespace emscape {

LoadedLibrary::LoadedLibrary(const std::vector<std::string>& files, const std::string& title,
                             const std::string& remedy) {
  std::string reason;  // of the first file, the one that is expected
  for (const std::string& file : files) {
    handle_ = ::dlopen(file.c_str(), RTLD_LAZY | RTLD_LOCAL);
    if (handle_ != nullptr) {
      file_ = file;
      return;
    }
    if (reason.empty()) reason = ::dlerror();
  }
  const bool is_memory_short = reason.find("failed to map segment") != std::string::npos ||
                               reason.find("Cannot allocate memory") != std::string::npos;
  throw Error(ErrorCode::other,
              "cannot load " + title + " (" + reason + "); " +
                  (is_memory_short ? "a limit on memory is reached (ulimit -v, or of a container)"
                   : ::access("/proc/self/exe", F_OK) != 0
                       ? "libraries beside the program are found by /proc/self/exe, which is not there"
                       : remedy));
}

void* LoadedLibrary::functionIfAny(const char* name) const {
  return ::dlsym(handle_, name);
}

void* LoadedLibrary::function(const char* name) const {
  void* const address = functionIfAny(name);
  if (address == nullptr)
    throw Error(ErrorCode::other, file_ + " has no function " + name + ": it is of an older version");
  return address;
}

}  // namespace emscape
