/// CUDA calls that throw on errors, and owned device memory. For .cu files and the .cpp files next to them.
#pragma once

#include <cuda_runtime_api.h>

#include <cstddef>
#include <string>
#include <utility>
#include <vector>

#include "emscape/base/error.h"

namespace emscape::cuda {

/// The last kernel that this thread launched; a failure inside a kernel is reported by a later call.
inline thread_local const char* last_kernel = nullptr;

/// @throws Error (device) that names the call, and the kernel launched before it, unless it succeeded
inline void check(cudaError_t status, const char* call) {
  if (status == cudaSuccess) return;
  std::string message =
      std::string("GPU: ") + call + ": " + cudaGetErrorString(status) + " (" + cudaGetErrorName(status) + ")";
  if (last_kernel != nullptr) message += std::string("; the last kernel launched was ") + last_kernel;
  throw Error(ErrorCode::device, message);
}

/// Called after the launch of a kernel. @param kernel its name, a literal. @throws Error (device) that names
/// the kernel
inline void checkLaunch(const char* kernel) {
  last_kernel = kernel;
  check(cudaGetLastError(), kernel);
}

/// The GPU of the calling thread.
inline int currentDevice() {
  int device = 0;
  check(cudaGetDevice(&device), "cudaGetDevice");
  return device;
}

/// While it lives, the calling thread uses a GPU; then the former one again.
class OnDevice {
 public:
  explicit OnDevice(int device) : former_(currentDevice()) {
    if (device != former_) check(cudaSetDevice(device), "cudaSetDevice");
  }
  ~OnDevice() { cudaSetDevice(former_); }
  OnDevice(const OnDevice&) = delete;
  OnDevice& operator=(const OnDevice&) = delete;

 private:
  int former_;
};

/// An array in device memory.
template <class T>
class Buffer {
 public:
  Buffer() = default;
  explicit Buffer(std::size_t count) { resize(count); }
  Buffer(Buffer&& other) noexcept { swap(other); }
  Buffer& operator=(Buffer&& other) noexcept {
    swap(other);
    return *this;
  }
  Buffer(const Buffer&) = delete;
  Buffer& operator=(const Buffer&) = delete;
  ~Buffer() { cudaFree(data_); }

  /// The contents are lost unless the size stays the same. @throws Error (device) with the requested size
  void resize(std::size_t count) {
    if (count == count_) return;
    cudaFree(std::exchange(data_, nullptr));
    count_ = 0;
    if (count == 0) return;
    const std::string call = "cudaMalloc of " + std::to_string(count * sizeof(T)) + " bytes";
    check(cudaMalloc(reinterpret_cast<void**>(&data_), count * sizeof(T)), call.c_str());
    count_ = count;
  }

  /// Grows to at least this length; the contents are lost if it grows. For sizes that vary little: it grows
  /// by a quarter and never shrinks, because freeing memory makes every stream wait.
  T* atLeast(std::size_t count) {
    if (count_ < count) resize(count_ == 0 ? count : count + count / 4);
    return data_;
  }
  /// Copies a vector; grows as by atLeast().
  T* send(const std::vector<T>& from, cudaStream_t stream) {
    atLeast(from.size());
    if (!from.empty()) {
      check(cudaMemcpyAsync(data_, from.data(), from.size() * sizeof(T), cudaMemcpyHostToDevice, stream),
            "cudaMemcpyAsync to the GPU");
    }
    return data_;
  }

  /// Copies `count` elements from host memory. Without a stream the call returns when the copy is complete.
  void upload(const T* from, std::size_t count, cudaStream_t stream = nullptr) {
    resize(count);
    if (count > 0) {
      check(cudaMemcpyAsync(data_, from, count * sizeof(T), cudaMemcpyHostToDevice, stream),
            "cudaMemcpyAsync to the GPU");
      if (stream == nullptr) check(cudaStreamSynchronize(stream), "cudaStreamSynchronize");
    }
  }
  void upload(const std::vector<T>& from, cudaStream_t stream = nullptr) {
    upload(from.data(), from.size(), stream);
  }
  /// Copies everything to host memory and waits for it.
  void download(T* to, cudaStream_t stream = nullptr) const { download(to, count_, stream); }
  /// Copies the first `count` elements.
  void download(T* to, std::size_t count, cudaStream_t stream) const {
    if (count == 0) return;
    check(cudaMemcpyAsync(to, data_, count * sizeof(T), cudaMemcpyDeviceToHost, stream),
          "cudaMemcpyAsync from the GPU");
    check(cudaStreamSynchronize(stream), "cudaStreamSynchronize");
  }

  T* data() { return data_; }
  const T* data() const { return data_; }
  std::size_t size() const { return count_; }

 private:
  void swap(Buffer& other) {
    std::swap(data_, other.data_);
    std::swap(count_, other.count_);
  }

  T* data_ = nullptr;
  std::size_t count_ = 0;
};

/// A stream of work.
class Stream {
 public:
  enum class Priority { normal, high };

  Stream() : Stream(Priority::normal) {}
  /// @param priority  thread blocks of `high` start before those that wait in other streams
  explicit Stream(Priority priority) {
    int least = 0, greatest = 0;
    check(cudaDeviceGetStreamPriorityRange(&least, &greatest), "cudaDeviceGetStreamPriorityRange");
    check(cudaStreamCreateWithPriority(&stream_, cudaStreamNonBlocking,
                                       priority == Priority::high ? greatest : least),
          "cudaStreamCreate");
  }
  ~Stream() { cudaStreamDestroy(stream_); }
  Stream(const Stream&) = delete;
  Stream& operator=(const Stream&) = delete;

  operator cudaStream_t() const { return stream_; }
  void wait() const { check(cudaStreamSynchronize(stream_), "cudaStreamSynchronize"); }

 private:
  cudaStream_t stream_ = nullptr;
};

/// A point of a stream to wait for; a wrapper of cudaEvent_t.
class Event {
 public:
  Event() { check(cudaEventCreateWithFlags(&event_, cudaEventDisableTiming), "cudaEventCreate"); }
  ~Event() { cudaEventDestroy(event_); }
  Event(const Event&) = delete;
  Event& operator=(const Event&) = delete;

  void record(cudaStream_t stream) { check(cudaEventRecord(event_, stream), "cudaEventRecord"); }
  /// Returns at once if nothing was recorded.
  void wait() const { check(cudaEventSynchronize(event_), "cudaEventSynchronize"); }
  /// True if the stream has reached the event; does not wait.
  bool isReached() const {
    const cudaError_t status = cudaEventQuery(event_);
    if (status == cudaErrorNotReady) {
      cudaGetLastError();  // clears the sticky error: cudaErrorNotReady is not a failure
      return false;
    }
    check(status, "cudaEventQuery");
    return true;
  }
  /// Work enqueued on the stream after this call waits for the event.
  void holdBack(cudaStream_t stream) const {
    check(cudaStreamWaitEvent(stream, event_, 0), "cudaStreamWaitEvent");
  }

 private:
  cudaEvent_t event_ = nullptr;
};

/// Asynchronous read of one value from the device.
template <class T>
class Readback {
 public:
  Readback() { check(cudaMallocHost(reinterpret_cast<void**>(&value_), sizeof(T)), "cudaMallocHost"); }
  ~Readback() { cudaFreeHost(value_); }
  Readback(const Readback&) = delete;
  Readback& operator=(const Readback&) = delete;

  /// Starts a read of the value after the work enqueued so far. An earlier read is discarded.
  void request(const T* from, cudaStream_t stream) {
    check(cudaMemcpyAsync(value_, from, sizeof(T), cudaMemcpyDeviceToHost, stream),
          "cudaMemcpyAsync from the GPU");
    arrives_.record(stream);
    is_awaited_ = true;
    has_value_ = false;
  }
  /// @return null if no read was started or it is not complete
  const T* arrived() {
    if (is_awaited_ && arrives_.isReached()) {
      is_awaited_ = false;
      has_value_ = true;
    }
    return has_value_ ? value_ : nullptr;
  }

 private:
  T* value_ = nullptr;
  Event arrives_;
  bool is_awaited_ = false, has_value_ = false;
};

/// A point of a stream with a time stamp.
class TimeMark {
 public:
  TimeMark() { check(cudaEventCreate(&event_), "cudaEventCreate"); }
  ~TimeMark() { cudaEventDestroy(event_); }
  TimeMark(const TimeMark&) = delete;
  TimeMark& operator=(const TimeMark&) = delete;

  void record(cudaStream_t stream) { check(cudaEventRecord(event_, stream), "cudaEventRecord"); }
  /// Waits until the stream has reached the mark. @param earlier recorded before, on the same stream
  double since_ms(const TimeMark& earlier) const {
    float ms = 0;
    check(cudaEventSynchronize(event_), "cudaEventSynchronize");
    check(cudaEventElapsedTime(&ms, earlier.event_, event_), "cudaEventElapsedTime");
    return ms;
  }

 private:
  cudaEvent_t event_ = nullptr;
};

/// Time between two points of a stream.
class Timer {
 public:
  void begin(cudaStream_t stream) { begin_.record(stream); }
  void end(cudaStream_t stream) { end_.record(stream); }
  /// Waits for the second point.
  double elapsed_ms() const { return end_.since_ms(begin_); }

 private:
  TimeMark begin_, end_;
};

}  // namespace emscape::cuda
