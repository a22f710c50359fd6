// To be preloaded into a program: blocks of 4 KiB and more end at an inaccessible page, and are never reused.
// An access beyond the end, or after the block was freed, ends the program, even by instructions that
// sanitizers do not see, such as gathers.
#include <sys/mman.h>

#include <atomic>
#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <cstring>

extern "C" {
void* __libc_malloc(std::size_t bytes);
void* __libc_memalign(std::size_t alignment, std::size_t bytes);
void* __libc_realloc(void* memory, std::size_t bytes);
void __libc_free(void* memory);
}

namespace {

constexpr std::size_t kPage = 4096, kSpace = std::size_t{1} << 42, kMinAlignment = 16;

/// Addresses without memory.
std::byte* space() {
  static std::byte* const begin = [] {
    constexpr int kKind = MAP_PRIVATE | MAP_ANONYMOUS | MAP_NORESERVE;
    void* const addresses = mmap(nullptr, kSpace, PROT_NONE, kKind, -1, 0);
    if (addresses == MAP_FAILED) std::abort();
    return static_cast<std::byte*>(addresses);
  }();
  return begin;
}
std::atomic<std::size_t> used{0};

/// In the page before a block.
struct Head {
  std::size_t bytes, pages;  ///< pages: of head and block
};
Head& headOf(void* memory) {
  const auto page = reinterpret_cast<std::uintptr_t>(memory) / kPage - 1;
  return *reinterpret_cast<Head*>(page * kPage);
}

bool isGuarded(const void* memory) {
  const auto* const at = static_cast<const std::byte*>(memory);
  return at >= space() && at < space() + kSpace;
}

void* allocateGuarded(std::size_t bytes, std::size_t alignment) {
  if (bytes > kSpace / 2 || alignment > kPage) return nullptr;
  const std::size_t rounded = (bytes + alignment - 1) / alignment * alignment;
  const std::size_t pages = 1 + (rounded + kPage - 1) / kPage;
  const std::size_t begin = used.fetch_add((pages + 1) * kPage);
  if (begin + (pages + 1) * kPage > kSpace) std::abort();
  std::byte* const first = space() + begin;
  if (mprotect(first, pages * kPage, PROT_READ | PROT_WRITE) != 0) return nullptr;
  std::byte* const memory = first + pages * kPage - rounded;
  headOf(memory) = {bytes, pages};
  return memory;
}

void freeGuarded(void* memory) {
  Head& head = headOf(memory);
  constexpr int kKind = MAP_PRIVATE | MAP_ANONYMOUS | MAP_NORESERVE | MAP_FIXED;
  mmap(&head, head.pages * kPage, PROT_NONE, kKind, -1, 0);
}

}  // namespace

extern "C" {

void* malloc(std::size_t bytes) {
  return bytes < kPage ? __libc_malloc(bytes) : allocateGuarded(bytes, kMinAlignment);
}

void* aligned_alloc(std::size_t alignment, std::size_t bytes) {
  const bool is_guarded = bytes >= kPage && alignment <= kPage;
  return is_guarded ? allocateGuarded(bytes, alignment) : __libc_memalign(alignment, bytes);
}

void free(void* memory) {
  isGuarded(memory) ? freeGuarded(memory) : __libc_free(memory);
}

void* realloc(void* memory, std::size_t bytes) {
  if (!isGuarded(memory)) return __libc_realloc(memory, bytes);
  void* const larger = malloc(bytes);
  if (larger == nullptr) return nullptr;
  const std::size_t before = headOf(memory).bytes;
  std::memcpy(larger, memory, before < bytes ? before : bytes);
  free(memory);
  return larger;
}

}  // extern "C"
