#include "playback/pictures/video.h"

#include <gtest/gtest.h>

#include <cstdlib>

#include "tests/support/temporary_folder.h"
#include "tests/support/working_folder.h"

namespace emscape::playback {
namespace {

TEST(Video, ItsNameMayLookLikeAnAddress) {
  if (std::system("command -v ffmpeg >/dev/null") != 0) GTEST_SKIP() << "needs the program ffmpeg";
  const test::TemporaryFolder folder;
  const test::WorkingFolder in(folder.path());
  render::Image8 frame;
  frame.size = {16, 16};
  frame.rgba.assign(16 * 16 * 4, 255);
  for (const char* name : {"12:30.mp4", "file:x.mp4", "-y.mp4"}) {
    VideoFile video(name, frame.size, 10);
    video.add(frame);
    video.finish();
    EXPECT_GT(std::filesystem::file_size(name), 0U) << name;
  }
  EXPECT_EQ(folder.files().size(), 3U);
}

}  // namespace
}  // namespace emscape::playback
