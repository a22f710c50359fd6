/// Outputs of pictures: one PNG, a folder of them, a video.
#pragma once

#include <filesystem>
#include <limits>
#include <memory>
#include <string>
#include <vector>

#include "base/files/own_file.h"
#include "emscape/render/picture/image.h"

namespace emscape::playback {

/// Takes the pictures of a series in order.
class PictureSink {
 public:
  virtual ~PictureSink() = default;
  /// @param number  counts from 1
  /// @param frames  of a video: number of frames that show the picture
  virtual void add(int number, const render::Image8& picture, int frames) = 0;
  /// After the last picture: gives the output its final name.
  virtual void finish() = 0;
};

/// Checks the extension before anything is computed. @throws Error (usage) as makePictureSink()
void checkPictureOutput(const std::filesystem::path& output);

/// Number of pictures: it is not known.
inline constexpr int kAnyNumber = std::numeric_limits<int>::max();

/// By the extension of `output`: .png (one picture), .mp4, or a folder (no extension) of NAME_0001.png, ....
/// @param pictures  number, at most  @param comment  of PNG files; may be empty
/// @param replaces  of one file, and of the pictures of a folder
/// @throws Error (usage) for another extension, a .png for several pictures, or a file that is to stay
std::unique_ptr<PictureSink> makePictureSink(const std::filesystem::path& output, const std::string& name,
                                             int pictures, render::ImageSize size, double frames_per_s,
                                             const std::string& comment, Replaces replaces = Replaces::own);

/// Finishes all, also those after one that fails. @throws what the first one threw; others are warned of
void finishAll(const std::vector<std::unique_ptr<PictureSink>>& sinks);

}  // namespace emscape::playback
