#include <utility>

#include "propagation/cuda/field_march_cuda.h"
#include "propagation/parabolic_equation/excess.h"

namespace emscape::propagation {
namespace {

using cuda::checkLaunch;

constexpr int kThreads = 256;

unsigned blocksFor(std::size_t count) {
  constexpr std::size_t kMaxBlocks = 4096;
  const std::size_t blocks = (count + kThreads - 1) / kThreads;
  return unsigned(blocks < kMaxBlocks ? blocks : kMaxBlocks);
}

/// Calls f(i) for i = 0 .. count - 1, in all threads of the grid.
template <class Function>
__device__ void each(std::size_t count, const Function& f) {
  for (std::size_t i = blockIdx.x * std::size_t(blockDim.x) + threadIdx.x; i < count;
       i += gridDim.x * std::size_t(blockDim.x))
    f(i);
}

__device__ float power(float loss_db) {
  return exp10f(-loss_db / 10);
}

/// The cells that a march reaches, by azimuth and range.
struct KnownCells {
  const int* ranges_by_azimuth;  ///< null: all
  int ranges, heights;           ///< of the grid of cells

  __device__ bool contain(std::size_t i) const {
    if (ranges_by_azimuth == nullptr) return true;
    const std::size_t of_range = i / std::size_t(heights);
    return int(of_range % std::size_t(ranges)) < ranges_by_azimuth[of_range / std::size_t(ranges)];
  }
};

/// Mean power of the polarisations, and finite losses; NaN in cells that are not known.
/// @param other_db  null: one polarisation
__global__ void finishMember(float* losses_db, const float* other_db, KnownCells known, std::size_t count) {
  each(count, [&](std::size_t i) {
    if (!known.contain(i)) {
      losses_db[i] = NAN;
      return;
    }
    float loss_db = losses_db[i];
    if (other_db != nullptr) loss_db = -10 * log10f((power(loss_db) + power(other_db[i])) / 2);
    losses_db[i] = loss_db > kPeNoField_db ? kPeNoField_db : loss_db;
  });
}

/// The loss at rank `place` in ascending order.
__device__ float ofRank_db(const float* losses_db, std::size_t pitch, int members, int rank) {
  for (int m = 0; m < members; ++m) {
    const float loss_db = losses_db[m * pitch];
    int before = 0, equal = 0;
    for (int n = 0; n < members; ++n) {
      before += losses_db[n * pitch] < loss_db ? 1 : 0;
      equal += losses_db[n * pitch] == loss_db ? 1 : 0;
    }
    if (before <= rank && rank < before + equal) return loss_db;
  }
  return NAN;
}

/// @param losses_db  of the members, `count` each
/// @param place      rank of the quantile; -1: the mean power
__global__ void ofMembers(const float* losses_db, std::size_t count, int members, int rank,
                          float* ensemble_db) {
  each(count, [&](std::size_t i) {
    if (rank >= 0) {
      ensemble_db[i] = ofRank_db(losses_db + i, count, members, rank);
      return;
    }
    double sum = 0;
    for (int m = 0; m < members; ++m) sum += double(power(losses_db[m * count + i]));
    ensemble_db[i] = float(-10 * log10(sum / members));
  });
}

}  // namespace

std::vector<BlockInput> FieldMarchCuda::inputs(FieldMarch& field) {
  std::vector<BlockInput> inputs;
  for (const auto& member : field.members) {
    for (const PeSurface& surface : field.surfaces) inputs.push_back(blockInput(field.set(member, surface)));
  }
  return inputs;
}

const float* FieldMarchCuda::start(FieldMarch& field, std::vector<BlockInput> inputs, cudaStream_t stream) {
  auto input = inputs.begin();
  const std::size_t count = field.cellCount(), members = field.members.size();
  const bool has_two = field.surfaces.size() > 1;
  const std::size_t needed = (members + (has_two || members > 1 ? 1 : 0)) * count;
  float* const last_db = losses_db_.atLeast(needed) + members * count;
  KnownCells known{nullptr, field.march.cells.ranges, field.march.cells.heights};
  if (!field.known_ranges.empty()) {
    known_ranges_.send(field.known_ranges, stream);
    known.ranges_by_azimuth = known_ranges_.data();
  }
  for (std::size_t m = 0; m < members; ++m) {
    float* const member_db = losses_db_.data() + m * count;
    march_.start(field.set(field.members[m], field.surfaces.front()), std::move(*input++), member_db, stream);
    if (has_two) {
      march_.start(field.set(field.members[m], field.surfaces.back()), std::move(*input++), last_db, stream);
    }
    finishMember<<<blocksFor(count), kThreads, 0, stream>>>(member_db, has_two ? last_db : nullptr, known,
                                                            count);
    checkLaunch("finishMember");
  }
  float* const result_db = members > 1 ? last_db : losses_db_.data();
  if (members > 1) {
    const int rank = field.quantile ? rankOfQuantile(*field.quantile, int(members)) : -1;
    ofMembers<<<blocksFor(count), kThreads, 0, stream>>>(losses_db_.data(), count, int(members), rank,
                                                         result_db);
    checkLaunch("ofMembers");
  }
  return result_db;
}

std::size_t FieldMarchCuda::bytes() const {
  return march_.bytes() + losses_db_.size() * sizeof(float) + known_ranges_.size() * sizeof(int);
}

}  // namespace emscape::propagation
