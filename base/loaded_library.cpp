#include "base/loaded_library.h"

#include <dlfcn.h>

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
  throw Error(ErrorCode::other, "cannot load " + title + " (" + reason + "); " + remedy);
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
