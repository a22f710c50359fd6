/// Cache of the weights of radars' looks, reused while only powers change.
#pragma once

#include <optional>
#include <vector>

#include "emfield/combine/look_weights.h"
#include "emfield/combine/radar_product.h"

namespace emscape::emfield {

/// A look that is unchanged in a second pass is computed once more and stored, or stored in its first pass if
/// others are expected; afterwards it is read. Results are bit-identical with and without the cache.
class LookWeightCache {
 public:
  /// @param slots            emitters with their own geometry
  /// @param voxels           of the grid
  /// @param available_bytes  keptBytes() of it are used
  LookWeightCache(std::size_t slots, std::size_t voxels, std::size_t available_bytes);

  /// The arrays for the next pass, which must be run with them.
  /// @param slot     of the radar; slots other than those of the constructor have no arrays
  /// @param antenna  of the radar
  /// @param share    none of its arrays are kept if its look has arcs
  /// @param has_more the radar enters other channels, too, which probably have the same look
  LookWeights choose(std::size_t slot, const scenario::AntennaPtr& antenna, const RadarShare& share,
                     bool has_more = false);
  /// The geometry of a slot has changed.
  void forget(std::size_t slot);
  std::size_t bytes() const { return taken_ * voxels_ * sizeof(float); }

 private:
  /// The echo of a look, or a jammer seen by it.
  struct Entry {
    scenario::AntennaPtr antenna;
    RadarShare share;  ///< without jammers
    std::optional<JammerAtRadar> jammer;
    std::vector<float> values;  ///< empty: has entered one pass
    bool is_known = false;
    long long last_pass = 0;
  };

  WeightArray choose(std::vector<Entry>& entries, const scenario::AntennaPtr& antenna,
                     const RadarShare& share, const JammerAtRadar* jammer, bool has_more);
  void release(Entry& entry);
  bool take(Entry& entry);

  std::size_t voxels_;
  std::size_t limit_;      // of taken_
  std::size_t taken_ = 0;  // arrays
  long long pass_ = 0;
  std::vector<std::vector<Entry>> slots_;
  std::vector<std::vector<float>> free_;
};

}  // namespace emscape::emfield
