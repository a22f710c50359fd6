#include <algorithm>

#include "base/cuda/cuda_memory.h"
#include "emfield/cuda/combine_kernels.h"

namespace emscape::emfield::cuda {
namespace {

using emscape::cuda::checkLaunch;
using scenario::PatternKind;

constexpr int kThreads = 128;

/// Largest size of a kernel's parameters.
constexpr int kParameterBytes = CUDART_VERSION >= 12010 ? 32000 : 4000;
/// Channels per launch: an emitter's power density is computed once for all of them.
constexpr int kMaxChannels = 4;

/// An emitter's contribution to the channels of a launch.
template <int kChannels>
struct Member {
  EmitterBeam beam;
  float* power_wm2;  ///< see CombineEmitter
  bool power_is_known;
  float weights[kChannels];
  bool takes_part[kChannels];
};

template <int kChannels>
struct Launch {
  static constexpr int kHeadBytes = 256;
  static constexpr int kMembers =
      std::min<int>(64, (kParameterBytes - kHeadBytes) / static_cast<int>(sizeof(Member<kChannels>)));

  Dims dims;
  const float* t_m;
  const std::uint16_t* first_valid_k;
  bool keep;
  int member_count;
  Reduction reductions[kChannels];
  Accumulator accumulators[kChannels];
  ConstAccumulator initial[kChannels];
  Member<kChannels> members[kMembers];
};

/// Power densities of one emitter in some layers of a column.
template <PatternKind kind, int kLayers>
__device__ void fillLayers(const EmitterBeam& beam, std::size_t column, const float (&t_m)[kLayers],
                           float (&power_density_wm2)[kLayers]) {
  const bool has_lobe = kind != PatternKind::isotropic && beam.pattern.lobe_tangent != 0;
#pragma unroll
  for (int l = 0; l < kLayers; ++l) {
    float depth = 0;
    if (has_lobe) power_density_wm2[l] = sideLobePowerDensity_wm2(beam, column, t_m[l], depth);
    if (depth >= 0) power_density_wm2[l] = powerDensity_wm2<kind>(beam, column, t_m[l]);
  }
}

/// Power density of both rays of a voxel. A separate call, so that it is compiled once per kernel.
__device__ __noinline__ float powerOfBothRays_wm2(const EmitterBeam& beam, long long voxel,
                                                  std::size_t column, float t_m) {
  return onPattern(beam.pattern, [&](auto kind) {
    return powerDensity_wm2<kind>(beam, beam.geometry.reflected[voxel], column, t_m);
  });
}

/// @param first   index of the lowest voxel of the column's layers
/// @param stride  from one layer to the next
/// @param count   layers that are in the grid
template <bool kReflected, int kLayers>
__device__ void fill(const EmitterBeam& beam, std::size_t column, long long first, long long stride,
                     int count, const float (&t_m)[kLayers], float (&power_density_wm2)[kLayers]) {
  if (kReflected && weighsReflectedRays(beam)) {
#pragma unroll
    for (int l = 0; l < kLayers; ++l) {
      if (l < count) power_density_wm2[l] = powerOfBothRays_wm2(beam, first + l * stride, column, t_m[l]);
    }
    return;
  }
  onPattern(beam.pattern, [&](auto kind) { fillLayers<kind>(beam, column, t_m, power_density_wm2); });
}

/// A warp of a block processes neighbouring columns, the next warp the layers above, so that they share the
/// columns' numbers in the first-level cache. Few layers per thread also keep the code of the patterns short.
constexpr int kWarp = 32;
constexpr int kWarps = 8;

/// A thread processes kLayers layers of a column.
/// @tparam kSecond     the channel has a second accumulator
/// @tparam kReflected  some members have weighted reflected rays, and some of the channels may be missing; a
/// separate kernel, because of its registers
template <int kChannels, int kLayers, bool kSecond, bool kReflected>
__global__ void __launch_bounds__(kWarp* kWarps)
    combineKernel(const __grid_constant__ Launch<kChannels> launch) {
  const int columns = launch.dims.x * launch.dims.y;
  const int column = static_cast<int>(blockIdx.x) * kWarp + static_cast<int>(threadIdx.x);
  if (column >= columns) return;
  const int begin = (static_cast<int>(blockIdx.y) * kWarps + static_cast<int>(threadIdx.y)) * kLayers;
  if (begin >= launch.dims.z) return;
  if (launch.first_valid_k != nullptr && launch.first_valid_k[column] >= begin + kLayers) return;

  float t_m[kLayers], power_density_wm2[kLayers], value[kChannels][kLayers];
  float second[kSecond ? kLayers : 1];
#pragma unroll
  for (int l = 0; l < kLayers; ++l) {
    const int k = begin + l < launch.dims.z ? begin + l : launch.dims.z - 1;
    const long long voxel = static_cast<long long>(k) * columns + column;
    t_m[l] = launch.t_m[k];
#pragma unroll
    for (int c = 0; c < kChannels; ++c) {
      const float* from = launch.keep ? launch.accumulators[c].value : launch.initial[c].value;
      value[c][l] = from != nullptr ? from[voxel] : initialValue(launch.reductions[c]);
    }
    if (kSecond) {
      const float* from = launch.keep ? launch.accumulators[0].second : launch.initial[0].second;
      second[l] = from != nullptr ? from[voxel] : 0.0F;
    }
  }

  for (int m = 0; m < launch.member_count; ++m) {
    __syncthreads();  // the block reads one member at a time: more do not fit into the cache of parameters
    const Member<kChannels>& member = launch.members[m];
    const long long first = static_cast<long long>(begin) * columns + column;
    if (member.power_is_known) {
#pragma unroll
      for (int l = 0; l < kLayers; ++l) {
        if (begin + l < launch.dims.z)
          power_density_wm2[l] = member.power_wm2[first + static_cast<long long>(l) * columns];
      }
    } else {
      fill<kReflected>(member.beam, column, first, columns, launch.dims.z - begin, t_m, power_density_wm2);
      if (!member.beam.geometry.excess.isEmpty()) {
        const ExcessView& excess = member.beam.geometry.excess;
#pragma unroll
        for (int l = 0; l < kLayers; ++l) {
          if (begin + l < launch.dims.z) {
            power_density_wm2[l] *= excess.factor(first + static_cast<long long>(l) * columns);
          }
        }
      }
      if (member.power_wm2 != nullptr) {
#pragma unroll
        for (int l = 0; l < kLayers; ++l) {
          if (begin + l < launch.dims.z)
            member.power_wm2[first + static_cast<long long>(l) * columns] = power_density_wm2[l];
        }
      }
    }
#pragma unroll
    for (int c = 0; c < kChannels; ++c) {
      if (!member.takes_part[c]) continue;
#pragma unroll
      for (int l = 0; l < kLayers; ++l) {
        if constexpr (kSecond) {
          float weight = member.weights[c];
          if (launch.reductions[c] == Reduction::dominant_mechanism) {
            if (begin + l < launch.dims.z)
              weight =
                  mechanismWeight(member.beam.geometry, weight, first + static_cast<long long>(l) * columns);
          }
          reduce(launch.reductions[c], weight, power_density_wm2[l], value[c][l], second[l]);
        } else {
          reduce(launch.reductions[c], member.weights[c], power_density_wm2[l], value[c][l]);
        }
      }
    }
  }

#pragma unroll
  for (int l = 0; l < kLayers; ++l) {
    if (begin + l >= launch.dims.z) break;
    const long long voxel = static_cast<long long>(begin + l) * columns + column;
#pragma unroll
    for (int c = 0; c < kChannels; ++c) {
      if (!kReflected || launch.accumulators[c].value != nullptr)
        launch.accumulators[c].value[voxel] = value[c][l];
    }
    if (kSecond) launch.accumulators[0].second[voxel] = second[l];
  }
}

/// Runs a pass for some channels of one kind, with as many launches as their members need.
/// @param count  channels; without reflected rays kChannels
template <int kChannels, bool kSecond, bool kReflected>
void combineChannels(const CombineTask& task, const std::uint16_t* first_valid_k, const int* channels,
                     int count, cudaStream_t stream) {
  constexpr int kLayers = 2;
  Launch<kChannels> launch;
  static_assert(sizeof launch <= kParameterBytes);
  launch.dims = task.dims;
  launch.t_m = task.t_m;
  launch.first_valid_k = first_valid_k;
  launch.keep = task.keep;
  launch.member_count = 0;
  for (int c = 0; c < kChannels; ++c) {
    launch.reductions[c] = c < count ? task.reductions[channels[c]] : Reduction::sum;
    launch.accumulators[c] = c < count ? task.accumulators[channels[c]] : Accumulator{};
    launch.initial[c] = c < count ? task.initial[channels[c]] : ConstAccumulator{};
  }
  constexpr int kBlockLayers = kLayers * kWarps;
  const dim3 blocks(static_cast<unsigned>((task.dims.x * task.dims.y + kWarp - 1) / kWarp),
                    static_cast<unsigned>((task.dims.z + kBlockLayers - 1) / kBlockLayers));
  const auto run = [&] {
    combineKernel<kChannels, kLayers, kSecond, kReflected>
        <<<blocks, dim3(kWarp, kWarps), 0, stream>>>(launch);
    checkLaunch("combine");
    launch.keep = true;
    launch.member_count = 0;
  };
  for (const CombineEmitter& emitter : task.emitters) {
    Member<kChannels> member{emitter.beam, emitter.power_wm2, emitter.power_is_known, {}, {}};
    bool takes_part = false;
    for (const ChannelWeight& share : emitter.shares) {
      for (int c = 0; c < count; ++c) {
        if (channels[c] != share.channel) continue;
        member.weights[c] = share.weight;
        takes_part = member.takes_part[c] = true;
      }
    }
    if (!takes_part) continue;
    launch.members[launch.member_count++] = member;
    if (launch.member_count == Launch<kChannels>::kMembers) run();
  }
  if (launch.member_count > 0 || !launch.keep) run();
}

template <Merge merge>
__global__ void __launch_bounds__(kThreads)
    mergeKernel(ConstAccumulator a, ConstAccumulator b, Accumulator into, std::size_t voxels) {
  const std::size_t voxel = static_cast<std::size_t>(blockIdx.x) * kThreads + threadIdx.x;
  if (voxel >= voxels) return;
  const float of_a = a.value[voxel], of_b = b.value[voxel];
  if constexpr (merge == Merge::add) {
    into.value[voxel] = of_a + of_b;
    if (into.second != nullptr) into.second[voxel] = a.second[voxel] + b.second[voxel];
  } else if constexpr (merge == Merge::either) {
    into.value[voxel] = of_a + of_b * (1 - of_a);
  } else if constexpr (merge == Merge::larger) {
    into.value[voxel] = of_b > of_a ? of_b : of_a;
  } else {
    const float strongest_a = a.second[voxel], strongest_b = b.second[voxel];
    into.value[voxel] = strongest_b > strongest_a ? of_b : of_a;
    into.second[voxel] = strongest_b > strongest_a ? strongest_b : strongest_a;
  }
}

/// Maps floats to unsigned integers of the same order.
__device__ unsigned orderOf(float value) {
  const unsigned bits = __float_as_uint(value);
  return (bits & 0x80000000u) != 0 ? ~bits : bits | 0x80000000u;
}

constexpr int kProductLayers = 4;

/// @tparam kForm  that of the task
template <ProductForm kForm>
__global__ void __launch_bounds__(kThreads) productKernel(DeviceProductTask task) {
  task.product.form = kForm;
  const Dims dims = task.voxels.dims;
  const int columns = dims.x * dims.y;
  const int column = static_cast<int>(blockIdx.x * blockDim.x + threadIdx.x);
  unsigned lowest = ~0u, highest = 0;
  if (column < columns) {
    const int i = column % dims.x, j = column / dims.x;
    const int first_valid = task.first_valid_k == nullptr ? 0 : task.first_valid_k[column];
    const int begin = static_cast<int>(blockIdx.y) * kProductLayers;
#pragma unroll
    for (int l = 0; l < kProductLayers; ++l) {
      const int k = begin + l;
      if (k >= dims.z) break;
      const int from = k < first_valid ? first_valid : k;
      float value = task.product.floor;
      if (from < dims.z) {
        const long long voxel = static_cast<long long>(from) * columns + column;
        const float second = kForm == ProductForm::signal_ratio ? task.second[voxel] : 0.0F;
        value = valueOf(task.product, task.accumulator[voxel], second);
      }
      task.voxels.write(i, j, k, value);
      if (k < first_valid || !(value > task.product.floor)) continue;
      const unsigned order = orderOf(value);
      lowest = min(lowest, order);
      highest = max(highest, order);
    }
  }
  lowest = __reduce_min_sync(~0u, lowest);
  highest = __reduce_max_sync(~0u, highest);
  if (threadIdx.x % warpSize == 0 && lowest <= highest) {
    atomicMin(&task.range->lowest, lowest);
    atomicMax(&task.range->highest, highest);
  }
}

}  // namespace

void combine(const CombineTask& task, const std::uint16_t* first_valid_k, cudaStream_t stream) {
  const bool has_reflected =
      std::any_of(task.emitters.begin(), task.emitters.end(),
                  [](const CombineEmitter& emitter) { return weighsReflectedRays(emitter.beam); });
  std::vector<int> channels;
  for (int c = 0; c < static_cast<int>(task.accumulators.size()); ++c) {
    if (task.accumulators[c].value == nullptr) continue;
    if (hasSecond(task.reductions[c])) {
      const auto combineOne =
          has_reflected ? combineChannels<1, true, true> : combineChannels<1, true, false>;
      combineOne(task, first_valid_k, &c, 1, stream);
    } else {
      channels.push_back(c);
    }
  }
  for (std::size_t begin = 0; begin < channels.size(); begin += kMaxChannels) {
    const int count = static_cast<int>(std::min<std::size_t>(kMaxChannels, channels.size() - begin));
    const auto combineSome = has_reflected ? combineChannels<kMaxChannels, false, true>
                             : count == 1  ? combineChannels<1, false, false>
                             : count == 2  ? combineChannels<2, false, false>
                             : count == 3  ? combineChannels<3, false, false>
                                           : combineChannels<kMaxChannels, false, false>;
    combineSome(task, first_valid_k, channels.data() + begin, count, stream);
  }
}

Merge mergeOf(const ChannelPlan& plan) {
  if (plan.occupancy_threshold_wm2 > 0) return Merge::either;
  if (!plan.radars.empty()) {
    const RadarTask& radar = plan.radars.front();
    const bool adds = radar.measure == RadarMeasure::detection && radar.reduction == Reduction::sum;
    return adds ? Merge::either : Merge::larger;
  }
  switch (plan.reduction) {
    case Reduction::sum:
    case Reduction::count:
    case Reduction::signal:
      break;
    case Reduction::maximum:
      return Merge::larger;
    case Reduction::dominant:
    case Reduction::dominant_mechanism:
      return Merge::stronger;
  }
  return Merge::add;
}

void mergeSums(Merge merge, ConstAccumulator a, ConstAccumulator b, Accumulator into, std::size_t voxels,
               cudaStream_t stream) {
  const auto kernel = [merge] {
    switch (merge) {
      case Merge::either:
        return mergeKernel<Merge::either>;
      case Merge::larger:
        return mergeKernel<Merge::larger>;
      case Merge::stronger:
        return mergeKernel<Merge::stronger>;
      case Merge::add:
        break;
    }
    return mergeKernel<Merge::add>;
  }();
  kernel<<<static_cast<unsigned>((voxels + kThreads - 1) / kThreads), kThreads, 0, stream>>>(a, b, into,
                                                                                             voxels);
  checkLaunch("merge of sums");
}

volume::ValueRange DeviceRange::range(float floor) const {
  const auto valueOf = [](unsigned order) {
    return fast_math_detail::floatOf((order & 0x80000000u) != 0 ? order & 0x7fffffffu : ~order);
  };
  if (lowest > highest) return {floor + 1, floor};
  return {valueOf(lowest), valueOf(highest)};
}

void makeProduct(const DeviceProductTask& task, cudaStream_t stream) {
  const Dims& dims = task.voxels.dims;
  const dim3 blocks(static_cast<unsigned>((dims.x * dims.y + kThreads - 1) / kThreads),
                    static_cast<unsigned>((dims.z + kProductLayers - 1) / kProductLayers));
  const auto kernel = [&task] {
    switch (task.product.form) {
      case ProductForm::itself:
        return productKernel<ProductForm::itself>;
      case ProductForm::signal_ratio:
        return productKernel<ProductForm::signal_ratio>;
      case ProductForm::age:
        return productKernel<ProductForm::age>;
      case ProductForm::decibels:
        break;
    }
    return productKernel<ProductForm::decibels>;
  }();
  kernel<<<blocks, kThreads, 0, stream>>>(task);
  checkLaunch("product");
}

}  // namespace emscape::emfield::cuda
