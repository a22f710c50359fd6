/// Copies between large arrays in pageable host memory and a GPU, through pinned memory that several threads
/// fill or empty. The driver copies such arrays on one thread.
#pragma once

#include <cuda_runtime_api.h>

#include <cstddef>
#include <functional>

#include "base/cuda/cuda_memory.h"

namespace emscape::cuda {

/// Copies to the GPU, on a stream. Returns when `fill` has been called for all bytes; the copy may still run.
/// @param fill(to, begin, end)  writes the bytes begin..end of the array; several threads call it. begin is a
/// multiple of 4096
/// @throws Error (device)
void uploadStaged(void* to, std::size_t bytes,
                  const std::function<void(char* to, std::size_t begin, std::size_t end)>& fill,
                  cudaStream_t stream);
/// Copies an array of host memory.
void uploadStaged(void* to, const void* from, std::size_t bytes, cudaStream_t stream);
/// Copies to host memory and waits for it. @throws Error (device)
void downloadStaged(void* to, const void* from, std::size_t bytes, cudaStream_t stream);

/// The same for a buffer, which is resized.
template <class T>
void uploadStaged(Buffer<T>& to, const T* from, std::size_t count, cudaStream_t stream) {
  to.resize(count);
  uploadStaged(to.data(), from, count * sizeof(T), stream);
}

}  // namespace emscape::cuda
