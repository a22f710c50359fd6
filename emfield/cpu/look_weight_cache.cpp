#include "emfield/cpu/look_weight_cache.h"

#include <algorithm>
#include <exception>
#include <utility>

#include "emfield/solver/field_inputs.h"
#include "emfield/solver/power_cache.h"

namespace emscape::emfield {
namespace {

/// Looks and jammers of a radar that are remembered.
constexpr std::size_t kMaxEntries = 16;

}  // namespace

LookWeightCache::LookWeightCache(std::size_t slots, std::size_t voxels, std::size_t available_bytes)
    : voxels_(voxels),
      limit_(keptBytes(available_bytes) / (sizeof(float) * std::max<std::size_t>(voxels, 1))),
      slots_(slots) {}

LookWeights LookWeightCache::choose(std::size_t slot, const scenario::AntennaPtr& antenna,
                                    const RadarShare& share, bool has_more) {
  LookWeights weights;
  if (slot >= slots_.size() || !share.arcs.directions.empty()) return weights;
  ++pass_;
  weights.echo = choose(slots_[slot], antenna, share, nullptr, has_more);
  for (const JammerAtRadar& jammer : share.jammers) {
    weights.jammers.push_back(choose(slots_[slot], antenna, share, &jammer, has_more));
  }
  return weights;
}

WeightArray LookWeightCache::choose(std::vector<Entry>& entries, const scenario::AntennaPtr& antenna,
                                    const RadarShare& share, const JammerAtRadar* jammer, bool has_more) {
  const auto entry = std::find_if(entries.begin(), entries.end(), [&](const Entry& known) {
    const bool is_jammer = known.jammer.has_value();
    return is_jammer == (jammer != nullptr) && (!is_jammer || sameRays(*known.jammer, *jammer)) &&
           sameLook(known.share, share) && samePattern(known.antenna, antenna);
  });
  if (entry != entries.end()) {
    entry->last_pass = pass_;
    const bool is_known = entry->is_known;
    if (!is_known && !take(*entry)) return {};
    entry->is_known = true;
    return {entry->values.data(), is_known};
  }
  Entry fresh;
  fresh.antenna = antenna;
  fresh.share = share;
  fresh.share.jammers.clear();
  if (jammer != nullptr) fresh.jammer = *jammer;
  fresh.last_pass = pass_;
  Entry* place = nullptr;
  if (entries.size() < kMaxEntries) {
    place = &entries.emplace_back();
  } else {
    place = &*std::min_element(entries.begin(), entries.end(),
                               [](const Entry& a, const Entry& b) { return a.last_pass < b.last_pass; });
    if (place->last_pass == pass_) return {};  // its array is used in this pass
    release(*place);
  }
  *place = std::move(fresh);
  if (!has_more || !take(*place)) return {};
  place->is_known = true;
  return {place->values.data(), false};
}

void LookWeightCache::forget(std::size_t slot) {
  if (slot >= slots_.size()) return;
  for (Entry& entry : slots_[slot]) release(entry);
  slots_[slot].clear();
}

void LookWeightCache::release(Entry& entry) {
  if (!entry.values.empty()) free_.push_back(std::move(entry.values));
  entry.values.clear();
  entry.is_known = false;
}

/// @return false if there is no memory for another array
bool LookWeightCache::take(Entry& entry) {
  if (!free_.empty()) {
    entry.values = std::move(free_.back());
    free_.pop_back();
    return true;
  }
  if (taken_ >= limit_) return false;
  try {
    entry.values.resize(voxels_);
  } catch (const std::exception&) {  // the memory is no longer available
    limit_ = taken_;
    return false;
  }
  ++taken_;
  return true;
}

}  // namespace emscape::emfield
