#include "playback/pictures/picture_sink.h"

#include <fmt/core.h>

#include <algorithm>
#include <charconv>
#include <exception>
#include <set>
#include <system_error>

#include "base/files/folder.h"
#include "base/files/folder_lock.h"
#include "base/files/unfinished_file.h"
#include "base/files/whole_file.h"
#include "emscape/base/error.h"
#include "emscape/base/log.h"
#include "emscape/volume/format/file.h"
#include "playback/pictures/video.h"
#include "playback/series/file_names.h"
#include "render/picture/png_comment.h"

namespace emscape::playback {
namespace {

namespace fs = std::filesystem;

fs::path folderOf(const fs::path& file) {
  return fs::absolute(file).parent_path();
}

void writeCommented(const fs::path& file, const render::Image8& picture, const std::string& comment,
                    Replaces replaces) {
  const std::string png = render::withPngComment(render::encodePng(picture), comment);
  writeWhole(
      file, [&](std::ostream& out) { out << png; }, replaces);
}

class OnePng : public PictureSink {
 public:
  OnePng(fs::path file, std::string comment, Replaces replaces)
      : file_(std::move(file)), comment_(std::move(comment)), replaces_(replaces) {
    removeAbandonedFiles(folderOf(file_));
  }
  void add(int /*number*/, const render::Image8& picture, int /*frames*/) override {
    writeCommented(file_, picture, comment_, replaces_);
  }
  void finish() override {}

 private:
  const fs::path file_;
  const std::string comment_;
  const Replaces replaces_;
};

class PngFolder : public PictureSink {
 public:
  PngFolder(fs::path folder, const std::string& name, int pictures, std::string comment, Replaces replaces)
      : folder_(made(std::move(folder))),
        name_(fileNameOf(name)),
        lock_(folder_, '.' + name_ + ".lock"),
        comment_(std::move(comment)),
        replaces_(replaces) {
    removeAbandonedFiles(folder_);
    for (const int number : numbersIn(folder_)) {
      if (replaces == Replaces::own && number <= pictures) requireOwn(fileOf(number));
    }
  }
  void add(int number, const render::Image8& picture, int /*frames*/) override {
    writeCommented(fileOf(number), picture, comment_, replaces_);
    last_ = std::max(last_, number);
  }
  /// Pictures of an earlier, longer run are the user's: they are named, not removed.
  void finish() override {
    std::set<int> others = numbersIn(folder_);
    others.erase(others.begin(), others.upper_bound(last_));
    if (others.empty()) return;
    logWarning(fmt::format("{}{} of an earlier run: this one wrote {} picture{}",
                           fileOf(*others.begin()).string(),
                           others.size() == 1 ? " is" : fmt::format(" and {} more are", others.size() - 1),
                           last_, last_ == 1 ? "" : "s"));
  }

 private:
  static fs::path made(fs::path folder) {
    makeFolder(folder);
    return folder;
  }
  fs::path fileOf(int number) const { return volume::seriesFile(folder_, name_, number, "png"); }
  /// The number in a picture's name; 0: it is not a picture of the series.
  int numberOf(const fs::path& file) const {
    const std::string name = file.filename().string(), begin = name_ + "_";
    if (name.rfind(begin, 0) != 0) return 0;
    int number = 0;
    std::from_chars(name.data() + begin.size(), name.data() + name.size(), number);
    return number > 0 && fileOf(number).filename() == name ? number : 0;
  }
  /// Of the pictures of the series in a folder.
  std::set<int> numbersIn(const fs::path& folder) const {
    std::set<int> numbers;
    std::error_code unread;
    for (fs::directory_iterator entry(folder, unread), end; !unread && entry != end;
         entry.increment(unread)) {
      if (const int number = numberOf(entry->path()); number > 0) numbers.insert(number);
    }
    return numbers;
  }

  const fs::path folder_;
  const std::string name_;
  const FolderLock lock_;  // the pictures of two runs would be mixed
  const std::string comment_;
  const Replaces replaces_;
  int last_ = 0;  ///< number of the last picture
};

class Video : public PictureSink {
 public:
  Video(const fs::path& file, render::ImageSize size, double frames_per_s, Replaces replaces)
      : video_(file, size, frames_per_s, replaces) {
    removeAbandonedFiles(folderOf(file));
  }
  void add(int /*number*/, const render::Image8& picture, int frames) override {
    for (int n = 0; n < frames; ++n) video_.add(picture);
  }
  void finish() override { video_.finish(); }

 private:
  VideoFile video_;
};

enum class OutputKind { png, video, folder };

OutputKind kindOf(const fs::path& output) {
  const std::string ending = output.extension().string();
  if (ending == ".png") return OutputKind::png;
  if (ending == ".mp4") return OutputKind::video;
  if (ending.empty() || fs::is_directory(output)) return OutputKind::folder;
  throw Error(
      ErrorCode::usage,
      fmt::format("{}: must end in .png or .mp4, or be a folder (without an ending)", output.string()));
}

}  // namespace

void checkPictureOutput(const fs::path& output) {
  kindOf(output);
}

std::unique_ptr<PictureSink> makePictureSink(const fs::path& output, const std::string& name, int pictures,
                                             render::ImageSize size, double frames_per_s,
                                             const std::string& comment, Replaces replaces) {
  switch (kindOf(output)) {
    case OutputKind::video:
      return std::make_unique<Video>(output, size, frames_per_s, replaces);
    case OutputKind::folder:
      return std::make_unique<PngFolder>(output, name, pictures, comment, replaces);
    case OutputKind::png:
      break;
  }
  if (pictures != 1) {
    throw Error(ErrorCode::usage,
                fmt::format("{}: one .png for {} pictures; name one time, a folder or an .mp4",
                            output.string(), pictures == kAnyNumber ? "several" : std::to_string(pictures)));
  }
  return std::make_unique<OnePng>(output, comment, replaces);
}

void finishAll(const std::vector<std::unique_ptr<PictureSink>>& sinks) {
  std::exception_ptr first;
  for (const auto& sink : sinks) {
    try {
      sink->finish();
    } catch (const Error& error) {
      if (first != nullptr) logWarning(error.what());
      if (first == nullptr) first = std::current_exception();
    }
  }
  if (first != nullptr) std::rethrow_exception(first);
}

}  // namespace emscape::playback
