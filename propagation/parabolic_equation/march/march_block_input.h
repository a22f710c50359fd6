/// Input of the march of all azimuths by blocks, prepared on the host.
#pragma once

#include <type_traits>
#include <vector>

#include "propagation/parabolic_equation/march/march_azimuths.h"
#include "propagation/parabolic_equation/march/march_block_run.h"

namespace emscape::propagation {

struct BlockInput {
  std::vector<int> intervals;         ///< N and its possible values after halving, descending
  std::vector<MarchBlockTask> tasks;  ///< of each, without pointers
  bool flat = false;                  ///< no terrain
  bool steady_air = false;            ///< one profile for all azimuths and ranges
  BlockKind kind = BlockKind::tables;
  std::vector<AirSegment> segments;
  std::vector<AirLevel> levels;
  std::vector<int> first_segment;
  std::vector<int> cell_end;
  std::vector<StoredComplex> start;  ///< field at range 0, by height
  std::vector<MarchState> states;    ///< of each azimuth
};

/// @param max_intervals  max N
/// @param columns_at  steps after which whole columns are kept, ascending; the march continues to the last
/// @throws Error (bad_input) as marchAzimuths(), for N outside kMinBlockIntervals .. kMaxBlockIntervals, and
/// for the narrow form over terrain or in changing air
BlockInput blockInput(const AzimuthMarch& march, int max_intervals = kMaxBlockIntervals,
                      const std::vector<int>& columns_at = {});

/// Calls function(std::integral_constant<BlockKind>()) for a kind.
template <class Function>
void withBlockKind(BlockKind kind, const Function& function) {
  switch (kind) {
    case BlockKind::tables:
      return function(std::integral_constant<BlockKind, BlockKind::tables>());
    case BlockKind::terrain:
      return function(std::integral_constant<BlockKind, BlockKind::terrain>());
    case BlockKind::mixed:
      return function(std::integral_constant<BlockKind, BlockKind::mixed>());
  }
}

}  // namespace emscape::propagation
