/// Frames that show differences to a reference, or the reference beside them. Internal to the module.
#pragma once

#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "emscape/playback/frames/frame_source.h"
#include "playback/frames/difference_series.h"
#include "playback/frames/platform_tracks.h"

namespace emscape::playback {

struct DifferenceReference {
  std::string name;            ///< for legends
  bool is_continuous = false;  ///< see VolumeSeries
  std::size_t cache_bytes = std::size_t{512} << 20;
};

/// Frames of a source, their differences to those of a reference at the same times, or both. Edits apply only
/// to the source: the reference's frames are cached and not recomputed after an edit. Frames must be
/// independent (FrameSelection::independent).
class DifferenceSource : public FrameSource {
 public:
  using Open = std::function<std::unique_ptr<FrameSource>()>;

  /// @param open  opens the reference, when it is first needed. May throw Error
  DifferenceSource(std::unique_ptr<FrameSource> source, Open open, const DifferenceReference& reference,
                   Comparison comparison);

  int count() const override { return source_->count(); }
  double time_s(int index) const override { return source_->time_s(index); }
  bool isContinuous() const override {
    return source_->isContinuous() && (!compares() || reference_is_continuous_);
  }
  std::string name() const override { return source_->name(); }
  const LoadedScenario* scene() const override { return source_->scene(); }
  scenario::Clock clock() const override { return source_->clock(); }
  std::vector<std::string> warnings() const override {
    return compares() ? difference_.warnings(source_->warnings()) : source_->warnings();
  }
  std::vector<std::string> quantities() const override { return source_->quantities(); }
  void setScenario(std::shared_ptr<const scenario::Scenario> scenario) override;
  void setPoses(PosesPtr poses) override { source_->setPoses(std::move(poses)); }
  void setQuantity(const std::string& quantity) override;
  void setComparison(Comparison comparison) override { comparison_ = comparison; }
  void setTimeGoal(double goal_ms) override { source_->setTimeGoal(goal_ms); }
  std::optional<Frame> withoutField(double time_s) override { return source_->withoutField(time_s); }
  std::size_t cachedBytes() const override { return difference_.cachedBytes(); }

 protected:
  /// @throws Error as DifferenceSeries::of(); as the sources; Stopped
  Frame makeFrame(int index) override { return compared(source_->frame(index)); }
  Frame makeFrameAt(double time_s) override { return compared(source_->frameAt(time_s)); }

 private:
  bool compares() const { return comparison_ != Comparison::none; }
  Frame compared(Frame frame);
  FieldBeside besideOf(const Frame& frame);

  std::unique_ptr<FrameSource> source_;
  Comparison comparison_;
  const std::string name_;  // of the reference
  const bool reference_is_continuous_;
  FrameSource* reference_ = nullptr;     // of difference_; null before it is opened
  std::optional<std::string> quantity_;  // that was set after the sources were opened
  DifferenceSeries difference_;
  PlatformTracks reference_tracks_;
};

}  // namespace emscape::playback
