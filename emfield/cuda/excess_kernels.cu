#include <algorithm>

#include "base/cuda/cuda_memory.h"
#include "emfield/cuda/excess_kernels.h"
#include "emfield/models/diffraction_column.h"

namespace emscape::emfield::cuda {
namespace {

using emscape::cuda::checkLaunch;

constexpr int kThreads = 128;
/// Receivers of a column that share a walk over its profile.
constexpr int kReceivers = 8;

unsigned blocksFor(int threads) {
  return static_cast<unsigned>((threads + kThreads - 1) / kThreads);
}

/// A column's profile as DiffractionColumn reads it: the fan's samples nearer than the column, linear between
/// the azimuths, as readProfile().
class FanPosts {
 public:
  __device__ FanPosts(const FanPiece& piece, const FanPlace& place)
      : ranges_m_(piece.emitter.fan.ranges_m), stride_(piece.interval_count + 1), distance_m_(place.range_m) {
    const int interval = static_cast<int>(place.azimuth_index);
    weight_ = static_cast<float>(place.azimuth_index - interval);
    heights_m_ = piece.samples + (interval - piece.first_interval);
    before_ = piece.emitter.fan.lastBefore(place.range_m);
  }

  __device__ int count() const { return before_ + 1; }
  __device__ double range_m(int i) const { return ranges_m_[i]; }
  __device__ float height_msl_m(int i) const {
    const float* left = heights_m_ + i * stride_;
    return left[0] + weight_ * (left[1] - left[0]);
  }
  __device__ double distance_m() const { return distance_m_; }
  __device__ float ground_msl_m() const { return ground_msl_m_; }
  __device__ void setGround_m(float height_msl_m) { ground_msl_m_ = height_msl_m; }
  __device__ int lastBefore(double range_m) const {
    int begin = 0, end = before_;
    while (begin < end) {
      const int middle = (begin + end + 1) / 2;
      if (ranges_m_[middle] < range_m) {
        begin = middle;
      } else {
        end = middle - 1;
      }
    }
    return begin;
  }

 private:
  const double* ranges_m_;
  const float* heights_m_;
  long long stride_;
  float weight_;
  int before_;
  double distance_m_;
  float ground_msl_m_ = 0;
};

__device__ void markUnknown(const ExcessOutputs& to, int column) {
  to.out.markUnknown(static_cast<std::size_t>(column));
  atomicAdd(&to.counts->unknown_columns, 1);
}

__global__ void __launch_bounds__(kThreads)
    diffractionKernel(const DiffractionTask* tasks, DeviceColumns columns, const float* ground_msl_m,
                      const std::uint16_t* first_valid_k) {
  const int c = static_cast<int>(blockIdx.x * blockDim.x + threadIdx.x);
  if (c >= columns.count) return;
  const DiffractionTask& task = tasks[blockIdx.y];
  const FanPlace place = task.piece.emitter.places[c];
  const int interval = static_cast<int>(place.azimuth_index) - task.piece.first_interval;
  if (interval < 0 || interval >= task.piece.interval_count) return;

  FanPosts posts(task.piece, place);
  ExcessCode* const codes = task.to.out.codes + c;
  const long long layer = columns.count;
  int k = first_valid_k == nullptr ? 0 : min(static_cast<int>(first_valid_k[c]), columns.layers);
  for (int below = 0; below < k; ++below) codes[below * layer] = 0;
  bool is_free = !(place.range_m > 0);  // the emitter's own place
  if (!is_free) {
    posts.setGround_m(ground_msl_m != nullptr ? ground_msl_m[c] : 0);
    DiffractionColumn<float, FanPosts> receivers(task.model.model, posts, task.model.tx_msl_m);
    if (receivers.isUnknown()) {
      markUnknown(task.to, c);
      for (; k < columns.layers; ++k) codes[k * layer] = kUnknownExcess;
    }
    const GridColumn& column = columns.columns[c];
    while (k < columns.layers && !is_free) {
      float rx_msl_m[kReceivers], loss_db[kReceivers];
#pragma unroll
      for (int j = 0; j < kReceivers; ++j) {
        const int here = min(k + j, columns.layers - 1);
        rx_msl_m[j] = static_cast<float>(heightMsl_m(column, static_cast<double>(columns.t_m[here])));
      }
      is_free = receivers.losses(rx_msl_m, loss_db);
#pragma unroll
      for (int j = 0; j < kReceivers; ++j) {
        if (k + j < columns.layers) codes[(k + j) * layer] = excessCode(loss_db[j]);
      }
      k += kReceivers;
    }
  }
  for (; k < columns.layers; ++k) codes[k * layer] = 0;
}

template <class Model>
__global__ void __launch_bounds__(kThreads)
    excessKernel(const __grid_constant__ ExcessTask<Model> task, const __grid_constant__ ExcessOutputs to,
                 char* memory, std::size_t bytes_each, int posts) {
  const int thread = static_cast<int>(blockIdx.x * blockDim.x + threadIdx.x);
  const int threads = static_cast<int>(gridDim.x * blockDim.x);
  const ExcessGrid& grid = task.grid;
  const ExcessScratch scratch = ExcessScratch::in(memory + thread * bytes_each, posts, grid.layers);
  for (std::size_t c = thread; c < grid.column_count; c += threads) {
    unsigned remarks = 0;
    if (!task.fillColumn(c, scratch, remarks)) continue;
    if ((remarks & kMissingTerrain) != 0) markUnknown(to, static_cast<int>(c));
    if ((remarks & ~kMissingTerrain) != 0) atomicOr(&to.counts->remarks, remarks & ~kMissingTerrain);
    for (int k = 0; k < grid.layers; ++k) {
      to.out.codes[k * grid.column_count + c] = excessCode(scratch.excess_db[k]);
    }
  }
}

template <class Model>
void launchExcess(const ExcessTask<Model>& task, const ExcessOutputs& to, void* scratch,
                  std::size_t scratch_bytes, cudaStream_t stream) {
  constexpr std::size_t kAlignment = alignof(double);
  const std::size_t bytes =
      (ExcessScratch::bytes(task.posts(), task.grid.layers) + kAlignment - 1) / kAlignment * kAlignment;
  const std::size_t fitting = scratch_bytes / bytes / kThreads * kThreads;
  if (fitting == 0) {
    throw Error(ErrorCode::device, "GPU: " + std::to_string(kThreads) + " columns at a time need " +
                                       std::to_string(kThreads * bytes) + " bytes, of " +
                                       std::to_string(scratch_bytes));
  }
  const std::size_t threads = std::min(fitting, task.grid.column_count);
  excessKernel<<<blocksFor(static_cast<int>(threads)), kThreads, 0, stream>>>(
      task, to, static_cast<char*>(scratch), bytes, task.posts());
  checkLaunch("excess");
}

}  // namespace

void fillDiffraction(const DiffractionTask* tasks, int count, const DeviceColumns& columns,
                     const float* ground_msl_m, const std::uint16_t* first_valid_k, cudaStream_t stream) {
  diffractionKernel<<<dim3(blocksFor(columns.count), static_cast<unsigned>(count)), kThreads, 0, stream>>>(
      tasks, columns, ground_msl_m, first_valid_k);
  checkLaunch("diffraction");
}

void fillExcess(const ExcessModel& model, const Station& station, const ExcessGrid& grid,
                const FanHeights& fan, const ExcessOutputs& to, void* scratch, std::size_t scratch_bytes,
                cudaStream_t stream) {
  std::visit(
      [&](const auto& m) {
        launchExcess(ExcessTask<std::decay_t<decltype(m)>>{m, station, grid, fan}, to, scratch, scratch_bytes,
                     stream);
      },
      model);
}

}  // namespace emscape::emfield::cuda
