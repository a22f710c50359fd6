#include "playback/pictures/video.h"

#include <fcntl.h>
#include <fmt/core.h>
#include <spawn.h>
#include <sys/mman.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cerrno>
#include <chrono>
#include <csignal>
#include <cstring>
#include <thread>
#include <vector>

#include "emscape/base/error.h"
#include "emscape/base/work.h"

extern char** environ;  // NOLINT: POSIX names it so

namespace emscape::playback {
namespace {

Error failure(const std::filesystem::path& path, const std::string& what) {
  return {ErrorCode::other, {path.string(), 0, 0}, what};
}

}  // namespace

VideoFile::VideoFile(std::filesystem::path path, render::ImageSize size, double frames_per_s,
                     Replaces replaces)
    : file_(std::move(path), replaces), size_(size) {
  // Without "file:" ffmpeg takes a name with a colon for an address.
  const std::vector<std::string> arguments{
      "ffmpeg", "-hide_banner", "-loglevel", "error", "-xerror", "-nostdin", "-y", "-f", "rawvideo",
      "-pixel_format", "rgb24", "-video_size", fmt::format("{}x{}", size.width, size.height), "-framerate",
      fmt::format("{}", frames_per_s), "-i", "pipe:0", "-an",
      // 4:2:0 needs even sizes
      "-vf", "pad=ceil(iw/2)*2:ceil(ih/2)*2", "-c:v", "libx264", "-preset", "medium", "-crf", "18",
      "-pix_fmt", "yuv420p", "-metadata", "comment=Emscape", "-movflags", "+faststart", "-f", "mp4",
      "file:" + file_.temporary().string()};
  std::vector<char*> argv;
  for (const std::string& argument : arguments) argv.push_back(const_cast<char*>(argument.c_str()));
  argv.push_back(nullptr);

  messages_ = Descriptor(::memfd_create("ffmpeg's messages", MFD_CLOEXEC));
  if (!messages_.isOpen())
    throw failure(file_.file(), std::string("cannot make a file in memory: ") + std::strerror(errno));
  int ends[2];
  if (pipe2(ends, O_CLOEXEC) != 0)
    throw failure(file_.file(), std::string("cannot make a pipe: ") + std::strerror(errno));
  posix_spawn_file_actions_t actions;
  posix_spawn_file_actions_init(&actions);
  posix_spawn_file_actions_adddup2(&actions, ends[0], STDIN_FILENO);
  posix_spawn_file_actions_adddup2(&actions, messages_.number(), STDOUT_FILENO);
  posix_spawn_file_actions_adddup2(&actions, messages_.number(), STDERR_FILENO);
  // In a process group of its own: a terminal sends Ctrl-C to this program alone, which then ends ffmpeg.
  posix_spawnattr_t attributes;
  posix_spawnattr_init(&attributes);
  posix_spawnattr_setflags(&attributes, POSIX_SPAWN_SETPGROUP);
  posix_spawnattr_setpgroup(&attributes, 0);
  const int error = posix_spawnp(&process_, "ffmpeg", &actions, &attributes, argv.data(), environ);
  posix_spawnattr_destroy(&attributes);
  posix_spawn_file_actions_destroy(&actions);
  close(ends[0]);
  pipe_ = ends[1];
  if (error != 0) {
    process_ = -1;
    closePipe();
    throw failure(file_.file(), error == ENOENT
                                    ? "writing a video needs the program ffmpeg, which is not on PATH"
                                    : std::string("cannot start ffmpeg: ") + std::strerror(error));
  }
}

VideoFile::~VideoFile() {
  if (process_ >= 0) {
    kill(process_, SIGKILL);
    closePipe();
    waitForEnd();
  }
}

void VideoFile::add(const render::Image8& frame) {
  if (!(frame.size == size_)) throw failure(file_.file(), "a frame of another size than the video's");
  std::vector<std::uint8_t> rgb(static_cast<std::size_t>(size_.count()) * 3);
  for (std::size_t pixel = 0; pixel < rgb.size() / 3; ++pixel) {
    std::memcpy(&rgb[3 * pixel], &frame.rgba[4 * pixel], 3);
  }
  for (std::size_t done = 0; done < rgb.size();) {
    const ssize_t written = write(pipe_, rgb.data() + done, rgb.size() - done);
    if (written < 0 && errno == EINTR) continue;
    if (written <= 0) fail("ffmpeg ended before the video was complete");
    done += static_cast<std::size_t>(written);
  }
}

void VideoFile::finish() {
  closePipe();
  // ffmpeg may encode and copy for seconds.
  int status = 0;
  for (pid_t ended = 0; (ended = waitpid(process_, &status, WNOHANG)) != process_;) {
    if (ended < 0 && errno != EINTR) break;
    checkpoint();
    std::this_thread::sleep_for(std::chrono::milliseconds(10));
  }
  process_ = -1;
  if (status != 0 || !reported().empty()) fail("ffmpeg could not write the video");
  std::error_code error;
  if (std::filesystem::file_size(file_.temporary(), error) == 0 || error) fail("ffmpeg wrote no video");
  file_.publish();
}

void VideoFile::fail(const std::string& what) {
  closePipe();
  if (process_ >= 0) waitForEnd();
  const std::string said = reported();
  throw failure(file_.file(), said.empty() ? what : what + ": " + said);
}

/// The first lines that ffmpeg wrote, joined.
std::string VideoFile::reported() const {
  constexpr std::size_t kMaxBytes = 500;
  std::string text(kMaxBytes, '\0');
  const ssize_t bytes = pread(messages_.number(), text.data(), text.size(), 0);
  text.resize(bytes > 0 ? static_cast<std::size_t>(bytes) : 0);
  while (!text.empty() && text.back() == '\n') text.pop_back();
  for (std::size_t end = text.find('\n'); end != std::string::npos; end = text.find('\n', end)) {
    text.replace(end, 1, "; ");
  }
  return text;
}

void VideoFile::closePipe() {
  if (pipe_ >= 0) close(pipe_);
  pipe_ = -1;
}

int VideoFile::waitForEnd() {
  int status = 0;
  while (waitpid(process_, &status, 0) < 0 && errno == EINTR) {
  }
  process_ = -1;
  return status;
}

}  // namespace emscape::playback
