/// Frames that show differences to a reference. Internal to the module.
#pragma once

#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "emscape/playback/frames/frame_source.h"
#include "playback/frames/frame_cache.h"

namespace emscape::playback {

/// volume::difference() of two volumes in any memory; the result is in host memory and has the time of `a`.
/// @param reference  name of `b`, stored as info().extra[kDifferenceToKey]
/// @throws Error (bad_input) as volume::difference(), (device)
volume::Volume differenceOf(const volume::Volume& a, const volume::Volume& b, const std::string& reference);
constexpr const char* kDifferenceToKey = "difference_to";

/// Frames of a source, or their differences to those of a reference at the same times. Edits apply only to
/// the source: the reference's frames are cached and not recomputed after an edit. Frames must be independent
/// (FrameSelection::independent).
class DifferenceSource : public FrameSource {
 public:
  using Open = std::function<std::unique_ptr<FrameSource>()>;

  /// @param open  opens the reference, when a difference is first requested. May throw Error
  /// @param name  of the reference, for legends
  DifferenceSource(std::unique_ptr<FrameSource> source, Open open, std::string name, bool compares);

  int count() const override { return source_->count(); }
  double time_s(int index) const override { return source_->time_s(index); }
  /// @throws Error (bad_input) if the reference has no step at that time or another grid or quantity, and for
  /// indices; as the sources; Stopped
  Frame frame(int index) override;
  std::string name() const override { return source_->name(); }
  const LoadedScenario* scene() const override { return source_->scene(); }
  std::vector<std::string> warnings() const override;
  void setScenario(std::shared_ptr<const scenario::Scenario> scenario) override;
  void setQuantity(const std::string& quantity) override;
  void setComparison(bool on) override { compares_ = on; }

  /// Sets the range of all frames to that of the differences of a part of the steps.
  /// @param progress  may be empty
  void findRange(const ProgressSink& progress);
  void setRange(const ValueRange& range) { range_ = range; }

 private:
  FrameSource& reference();
  volume::Volume referenceVolume(double time_s);

  std::unique_ptr<FrameSource> source_;
  const Open open_;
  const std::string name_;
  bool compares_;
  std::unique_ptr<FrameSource> reference_;
  std::optional<std::string> quantity_;  // that was set after the sources were opened
  FrameCache cache_;                     // of the reference
  std::optional<ValueRange> range_;
};

}  // namespace emscape::playback
