/// What the readers of tracks in XML share.
#pragma once

#include <fmt/format.h>

#include <filesystem>
#include <string>

#include "recording/common/text.h"
#include "recording/common/track_recorder.h"
#include "recording/common/xml.h"

namespace emscape::interop {

/// Base of a reader, whose times are UTC.
class XmlTracks {
 public:
  XmlTracks(const char* format, const std::string& name, const ReadOptions& options)
      : stem_(std::filesystem::path(name).stem().string()), recorder_(format, options) {
    recorder_.hasUtc();
  }

 protected:
  /// A new object: several may have the same name. Without a name it has that of the file.
  std::size_t newObject(const std::string& name) {
    const std::size_t object = recorder_.objectOf(fmt::format("{}", ++objects_));
    recorder_.object(object).name = name.empty() ? stem_ : name;
    return object;
  }
  static std::string nameIn(const pugi::xml_node& node) { return printableText(textOf(node, "name")); }
  /// The place of the next record, for messages.
  std::string nextLocation(const char* kind) {
    return fmt::format("{} {}", kind, ++recorder_.tally().records);
  }

  std::string stem_;
  TrackRecorder recorder_;

 private:
  int objects_ = 0;
};

/// Reads a file with a reader that has `Recording read(const pugi::xml_node& root)`.
template <class Reader>
Recording readXmlTracks(ByteSource& source, const std::string& name, const ReadOptions& options,
                        const char* root) {
  pugi::xml_document document;
  std::string told;
  const std::string torn = loadXml(source, name, document, &told);
  Recording recording = Reader(name, options).read(childOf(document, root));
  recording.tally.torn = torn;
  if (!told.empty()) recording.tally.notes.push_back(told);
  return recording;
}

}  // namespace emscape::interop
