// To be preloaded into a program: makes one allocation by `operator new` fail. Counts allocations of
// EMSCAPE_FAILING_BYTES or more during main(); the EMSCAPE_FAILING_ALLOCATION-th one fails (1, 2, ...; unset:
// none), or the next one outside GDAL, its libraries and Mesa's driver, which omit results for lack of
// memory, or crash, outside the loader of libraries, whose constructors cannot report it, and outside the
// ranges of the program's code in EMSCAPE_SPARED_CODE: "BEGIN-END ...", in hexadecimal bytes from its begin.
// If EMSCAPE_ALLOCATIONS names a file, the count is written into it. malloc() is not affected, since C
// libraries end the program when it fails.
#include <dlfcn.h>
#include <execinfo.h>

#include <atomic>
#include <cstddef>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <initializer_list>
#include <new>

namespace {

using Main = int (*)(int, char**, char**);

std::atomic<long long> allocations{0};
std::atomic<bool> is_counting{false};
std::atomic<long long> failing{0};  ///< 0: none, or it has already failed
std::size_t least_bytes = 1;
Main program;

/// @param address  in bytes from the begin of the program
bool isSpared(unsigned long long address) {
  static const char* const ranges = std::getenv("EMSCAPE_SPARED_CODE");
  unsigned long long begin = 0, end = 0;
  int length = 0;
  for (const char* at = ranges; at != nullptr && std::sscanf(at, "%llx-%llx%n", &begin, &end, &length) == 2;
       at += length) {
    if (address >= begin && address < end) return true;
  }
  return false;
}

bool isWithinFragileCode() {
  static const void* const program_begin = [] {
    Dl_info found{};
    dladdr(reinterpret_cast<void*>(program), &found);
    return found.dli_fbase;
  }();
  void* frames[128];
  const int count = backtrace(frames, 128);
  for (int n = 0; n < count; ++n) {
    Dl_info found{};
    if (dladdr(frames[n], &found) == 0 || found.dli_fname == nullptr) continue;
    if (found.dli_fbase == program_begin &&
        isSpared(static_cast<unsigned long long>(static_cast<char*>(frames[n]) -
                                                 static_cast<const char*>(program_begin))))
      return true;
    for (const char* const library :
         {"ld-linux", "libgdal", "libproj", "libnetcdf", "libhdf5", "libLLVM", "swrast_dri"}) {
      if (std::strstr(found.dli_fname, library) != nullptr) return true;
    }
  }
  return false;
}

bool fails(std::size_t bytes) {
  if (bytes < least_bytes || !is_counting.load(std::memory_order_relaxed)) return false;
  const long long number = ++allocations;
  long long first = failing.load(std::memory_order_relaxed);
  return first != 0 && number >= first && !isWithinFragileCode() && failing.compare_exchange_strong(first, 0);
}

void* allocate(std::size_t bytes, std::size_t alignment) {
  if (fails(bytes)) return nullptr;
  if (bytes == 0) bytes = 1;
  return alignment <= alignof(std::max_align_t)
             ? std::malloc(bytes)
             : std::aligned_alloc(alignment, (bytes + alignment - 1) / alignment * alignment);
}

void* allocateOrThrow(std::size_t bytes, std::size_t alignment) {
  void* const memory = allocate(bytes, alignment);
  if (memory == nullptr) throw std::bad_alloc();
  return memory;
}

int countedMain(int count, char** arguments, char** environment) {
  if (const char* const text = std::getenv("EMSCAPE_FAILING_ALLOCATION")) failing = std::atoll(text);
  if (const char* const text = std::getenv("EMSCAPE_FAILING_BYTES"))
    least_bytes = static_cast<std::size_t>(std::atoll(text));
  is_counting = true;
  const int status = program(count, arguments, environment);
  is_counting = false;
  if (const char* const name = std::getenv("EMSCAPE_ALLOCATIONS")) {
    if (std::FILE* const file = std::fopen(name, "w")) {
      std::fprintf(file, "%lld\n", allocations.load());
      std::fclose(file);
    }
  }
  return status;
}

}  // namespace

void* operator new(std::size_t bytes) {
  return allocateOrThrow(bytes, 1);
}
void* operator new[](std::size_t bytes) {
  return allocateOrThrow(bytes, 1);
}
void* operator new(std::size_t bytes, std::align_val_t alignment) {
  return allocateOrThrow(bytes, static_cast<std::size_t>(alignment));
}
void* operator new[](std::size_t bytes, std::align_val_t alignment) {
  return allocateOrThrow(bytes, static_cast<std::size_t>(alignment));
}
void* operator new(std::size_t bytes, const std::nothrow_t&) noexcept {
  return allocate(bytes, 1);
}
void* operator new[](std::size_t bytes, const std::nothrow_t&) noexcept {
  return allocate(bytes, 1);
}
void* operator new(std::size_t bytes, std::align_val_t alignment, const std::nothrow_t&) noexcept {
  return allocate(bytes, static_cast<std::size_t>(alignment));
}
void* operator new[](std::size_t bytes, std::align_val_t alignment, const std::nothrow_t&) noexcept {
  return allocate(bytes, static_cast<std::size_t>(alignment));
}
void operator delete(void* memory) noexcept {
  std::free(memory);
}
void operator delete[](void* memory) noexcept {
  std::free(memory);
}
void operator delete(void* memory, std::size_t) noexcept {
  std::free(memory);
}
void operator delete[](void* memory, std::size_t) noexcept {
  std::free(memory);
}
void operator delete(void* memory, std::align_val_t) noexcept {
  std::free(memory);
}
void operator delete[](void* memory, std::align_val_t) noexcept {
  std::free(memory);
}
void operator delete(void* memory, std::size_t, std::align_val_t) noexcept {
  std::free(memory);
}
void operator delete[](void* memory, std::size_t, std::align_val_t) noexcept {
  std::free(memory);
}

/// Replaces the C library's function, called by the program's first instructions, in order to count within
/// main().
extern "C" int __libc_start_main(Main main, int count, char** arguments, void (*begin)(), void (*end)(),
                                 void (*unload)(), void* stack) {
  using Start = int (*)(Main, int, char**, void (*)(), void (*)(), void (*)(), void*);
  program = main;
  const auto original = reinterpret_cast<Start>(dlsym(RTLD_NEXT, "__libc_start_main"));
  return original(countedMain, count, arguments, begin, end, unload, stack);
}
