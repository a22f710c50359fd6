// To be preloaded into a program: every write to a file writes at most half of the bytes, as a write that a
// signal interrupts may do. Programs must write the rest.
#include <dlfcn.h>
#include <sys/stat.h>
#include <sys/uio.h>
#include <unistd.h>

#include <cstddef>

namespace {

/// Pipes and sockets are not affected.
bool isFile(int file) {
  struct stat status {};
  return fstat(file, &status) == 0 && S_ISREG(status.st_mode);
}

std::size_t half(int file, std::size_t count) {
  return count > 1 && isFile(file) ? count / 2 : count;
}

template <class Function>
Function* next(const char* name) {
  return reinterpret_cast<Function*>(dlsym(RTLD_NEXT, name));
}

}  // namespace

extern "C" {

ssize_t write(int file, const void* bytes, std::size_t count) {
  static auto* const original = next<ssize_t(int, const void*, std::size_t)>("write");
  return original(file, bytes, half(file, count));
}

ssize_t pwrite64(int file, const void* bytes, std::size_t count, off64_t offset) {
  static auto* const original = next<ssize_t(int, const void*, std::size_t, off64_t)>("pwrite64");
  return original(file, bytes, half(file, count), offset);
}

ssize_t pwrite(int file, const void* bytes, std::size_t count, off_t offset) {
  return pwrite64(file, bytes, count, offset);
}

/// Writes only half of the first part.
ssize_t writev(int file, const iovec* parts, int count) {
  static auto* const original = next<ssize_t(int, const iovec*, int)>("writev");
  if (!isFile(file)) return original(file, parts, count);
  for (int part = 0; part < count; ++part) {
    if (parts[part].iov_len > 0) return write(file, parts[part].iov_base, parts[part].iov_len);
  }
  return 0;
}

}  // extern "C"
