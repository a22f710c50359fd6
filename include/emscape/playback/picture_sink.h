/// Where pictures go: one PNG, a folder of them, a video.
#pragma once

#include <filesystem>
#include <memory>
#include <string>

#include "emscape/render/image.h"

namespace emscape::playback {

/// Takes the pictures of a series in order.
class PictureSink {
 public:
  virtual ~PictureSink() = default;
  /// @param number  counts from 1
  /// @param frames  of a video: for so many the picture is seen
  virtual void add(int number, const render::Image8& picture, int frames) = 0;
  /// After the last picture: what was written lies under its final name.
  virtual void finish() = 0;
};

/// By the ending of `output`: .png (one picture), .mp4, or a folder (no ending) of NAME_0001.png, ....
/// @throws Error (usage) for another ending, or a .png for several pictures
std::unique_ptr<PictureSink> makePictureSink(const std::filesystem::path& output, const std::string& name,
                                             int pictures, render::ImageSize size, double frames_per_s);

}  // namespace emscape::playback
