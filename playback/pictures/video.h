/// Videos, through the program ffmpeg.
#pragma once

#include <sys/types.h>

#include <filesystem>
#include <string>

#include "base/files/descriptor.h"
#include "base/files/unfinished_file.h"
#include "emscape/render/picture/image.h"

namespace emscape::playback {

/// Writes one .mp4 (H.264, yuv420p): the frames are passed to ffmpeg through a pipe, and the file is renamed
/// when it is complete.
class VideoFile {
 public:
  /// @throws Error (other) if there is no ffmpeg on PATH or it does not start; (usage) as requireOwn()
  VideoFile(std::filesystem::path path, render::ImageSize size, double frames_per_s,
            Replaces replaces = Replaces::own);
  /// Without finish(), no file remains.
  ~VideoFile();
  VideoFile(const VideoFile&) = delete;
  VideoFile& operator=(const VideoFile&) = delete;

  /// Adds an opaque frame of the video's size. @throws Error (other) if ffmpeg has ended
  void add(const render::Image8& frame);
  /// @throws Error (other) if ffmpeg failed or reported any error: it ends with status 0 after some errors,
  /// such as a full disk
  void finish();

 private:
  void closePipe();
  int waitForEnd();
  /// Ends the process and throws what it reported.
  [[noreturn]] void fail(const std::string& what);
  std::string reported() const;

  UnfinishedFile file_;
  const render::ImageSize size_;
  int pipe_ = -1;
  Descriptor messages_;  ///< a file in memory for ffmpeg's standard output and error
  pid_t process_ = -1;
};

}  // namespace emscape::playback
