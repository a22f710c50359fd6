#include "base/cuda/staged_copy.h"

#include <algorithm>
#include <atomic>
#include <cstring>
#include <map>
#include <mutex>
#include <vector>

#include "emscape/base/parallel.h"

namespace emscape::cuda {
namespace {

constexpr std::size_t kChunk = std::size_t{2} << 20;
constexpr int kChunks = 3;
constexpr std::size_t kPiece = std::size_t{128} << 10;  ///< of a chunk, for one thread

/// Pinned memory for the copies of one GPU, to which its events belong. Allocating it takes milliseconds, so
/// it is kept until the process ends.
class Stage {
 public:
  Stage() { check(cudaMallocHost(reinterpret_cast<void**>(&memory_), kChunk * kChunks), "cudaMallocHost"); }
  char* chunk(std::size_t n) { return memory_ + n % kChunks * kChunk; }
  Event& copied(std::size_t n) { return copied_[n % kChunks]; }
  /// That of the calling thread's GPU.
  static Stage& here() {
    static std::mutex mutex;
    static auto* const stages = new std::map<int, Stage*>;
    const std::lock_guard lock(mutex);
    Stage*& stage = (*stages)[currentDevice()];
    if (stage == nullptr) stage = new Stage;
    return *stage;
  }

  std::atomic<bool> is_used{false};

 private:
  char* memory_ = nullptr;
  Event copied_[kChunks];
};

/// Exclusive use of the stage. It is not waited for: a thread that waits in a parallel loop may run another
/// task that copies.
class Use {
 public:
  Use() : stage_(Stage::here()), has_stage_(!stage_.is_used.exchange(true)) {}
  ~Use() {
    if (has_stage_) stage_.is_used = false;
  }
  Use(const Use&) = delete;
  Use& operator=(const Use&) = delete;
  bool hasStage() const { return has_stage_; }
  Stage& stage() const { return stage_; }

 private:
  Stage& stage_;
  bool has_stage_;
};

/// Calls f(begin, end) for the pieces of a range of bytes.
template <class Function>
void forPieces(std::size_t begin, std::size_t end, const Function& f) {
  const auto pieces = static_cast<int>((end - begin + kPiece - 1) / kPiece);
  parallelFor(pieces, 1, [&](int first, int last) {
    f(begin + static_cast<std::size_t>(first) * kPiece,
      std::min(begin + static_cast<std::size_t>(last) * kPiece, end));
  });
}

}  // namespace

void uploadStaged(void* to, std::size_t bytes,
                  const std::function<void(char* to, std::size_t begin, std::size_t end)>& fill,
                  cudaStream_t stream) {
  const auto send = [&](const char* from, std::size_t begin, std::size_t end) {
    check(cudaMemcpyAsync(static_cast<char*>(to) + begin, from, end - begin, cudaMemcpyHostToDevice, stream),
          "cudaMemcpyAsync to the GPU");
  };
  if (bytes == 0) return;
  const Use use;
  if (!use.hasStage()) {
    std::vector<char> filled(bytes);
    fill(filled.data(), 0, bytes);
    send(filled.data(), 0, bytes);  // pageable: returns when the memory was read
    return;
  }
  Stage& stage = use.stage();
  for (std::size_t n = 0; n * kChunk < bytes; ++n) {
    const std::size_t begin = n * kChunk, end = std::min(begin + kChunk, bytes);
    char* const chunk = stage.chunk(n);
    stage.copied(n).wait();
    forPieces(begin, end,
              [&](std::size_t first, std::size_t last) { fill(chunk + (first - begin), first, last); });
    send(chunk, begin, end);
    stage.copied(n).record(stream);
  }
}

void uploadStaged(void* to, const void* from, std::size_t bytes, cudaStream_t stream) {
  uploadStaged(
      to, bytes,
      [from](char* part, std::size_t begin, std::size_t end) {
        std::memcpy(part, static_cast<const char*>(from) + begin, end - begin);
      },
      stream);
}

void downloadStaged(void* to, const void* from, std::size_t bytes, cudaStream_t stream) {
  const auto receive = [&](char* at, std::size_t begin, std::size_t end) {
    check(cudaMemcpyAsync(at, static_cast<const char*>(from) + begin, end - begin, cudaMemcpyDeviceToHost,
                          stream),
          "cudaMemcpyAsync from the GPU");
  };
  if (bytes == 0) return;
  const Use use;
  if (!use.hasStage()) {
    receive(static_cast<char*>(to), 0, bytes);
    check(cudaStreamSynchronize(stream), "cudaStreamSynchronize");
    return;
  }
  Stage& stage = use.stage();
  const std::size_t chunks = (bytes + kChunk - 1) / kChunk;
  const auto begin = [&](std::size_t n) { return std::min(n * kChunk, bytes); };
  const auto start = [&](std::size_t n) {
    if (n >= chunks) return;
    stage.copied(n).wait();
    receive(stage.chunk(n), begin(n), begin(n + 1));
    stage.copied(n).record(stream);
  };
  for (std::size_t n = 0; n < kChunks; ++n) start(n);
  for (std::size_t n = 0; n < chunks; ++n) {
    stage.copied(n).wait();
    forPieces(begin(n), begin(n + 1), [&](std::size_t first, std::size_t last) {
      std::memcpy(static_cast<char*>(to) + first, stage.chunk(n) + (first - begin(n)), last - first);
    });
    start(n + kChunks);
  }
}

}  // namespace emscape::cuda
