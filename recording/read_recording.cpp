#include "recording/read_recording.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <filesystem>
#include <memory>

#include "base/text/count_text.h"
#include "emscape/base/error.h"
#include "emscape/base/work.h"
#include "recording/acmi/acmi_reader.h"
#include "recording/common/samples.h"
#include "recording/common/text.h"
#include "recording/cot/cot_reader.h"
#include "recording/dis/dis_recorder.h"
#include "recording/simdis/asi_reader.h"
#include "recording/tracks/track_formats.h"

namespace emscape::interop {
namespace {

enum class Format {
  unknown,
  acmi,
  capture,
  hex_log,
  session,
  asi,
  cot,
  gpx,
  kml,
  stk,
  nmea,
  czml,
  table,
  utf16,
  packed,
  empty
};

constexpr std::string_view kZipBegin = "PK\x03\x04", kGzipBegin = "\x1F\x8B";
constexpr std::string_view kPackedBegins[] = {"7z\xBC\xAF\x27\x1C",
                                              "\xFD"
                                              "7zXZ",
                                              "BZh", "\x28\xB5\x2F\xFD"};  // 7z, xz, bzip2, zstd

bool beginsWith(std::string_view text, std::string_view begin) {
  return text.substr(0, begin.size()) == begin;
}

/// The first line is a time in seconds, the second one bytes in hexadecimal.
bool isHexLog(std::string_view head) {
  const std::size_t end = head.find('\n');
  if (end == std::string_view::npos || end == 0 || end > 40) return false;
  const auto within = [](std::string_view text, std::string_view allowed) {
    return text.find_first_not_of(allowed) == std::string_view::npos;
  };
  const std::string_view second = head.substr(end + 1, head.find('\n', end + 1) - end - 1);
  return within(head.substr(0, end), "0123456789.eE+-\r ") && second.size() >= 24 &&
         within(second, "0123456789abcdefABCDEF \r");
}

/// A record of Disco begins with a time, a size and the header of a PDU.
bool isSession(std::string_view head) {
  if (head.size() < 22) return false;
  const auto* const bytes = reinterpret_cast<const std::uint8_t*>(head.data());
  const std::size_t size = std::size_t{bytes[8]} << 8 | bytes[9];
  const std::size_t length = std::size_t{bytes[18]} << 8 | bytes[19];
  return bytes[0] == 0 && bytes[1] == 0 && size == length && bytes[10] >= 1 && bytes[10] <= 7;
}

/// The first line has a sentence of NMEA 0183, $GPRMC,..., perhaps after the time of its arrival.
bool isNmea(std::string_view head) {
  head = head.substr(0, head.find('\n'));
  constexpr std::size_t kLongestStamp = 40;
  const std::size_t at = head.find_first_of("$!");
  if (at > kLongestStamp) return false;
  head.remove_prefix(at);
  return head.size() > 7 && (head[0] == '$' || head[0] == '!') &&
         head.substr(1, 5).find_first_not_of("ABCDEFGHIJKLMNOPQRSTUVWXYZ") == std::string_view::npos &&
         head[6] == ',';
}

/// The format of an XML file or of CZML; unknown for others.
Format markupOf(std::string_view head) {
  const std::size_t begin = head.find_first_not_of("\xEF\xBB\xBF \t\r\n");
  if (begin == std::string_view::npos) return Format::unknown;
  const auto has = [head](std::string_view text) { return head.find(text) != std::string_view::npos; };
  const auto hasElement = [&has](const std::string& name) {
    return has("<" + name) || has(":" + name + " ");  // with the prefix of a namespace
  };
  if (head[begin] == '[' && has("\"id\"")) return Format::czml;
  if (head[begin] != '<') return Format::unknown;
  if (hasElement("gpx")) return Format::gpx;
  if (hasElement("kml")) return Format::kml;
  return isCot(head) ? Format::cot : Format::unknown;
}

Format formatOf(std::string_view head, const ReadOptions& options) {
  constexpr std::string_view kMark = "\xEF\xBB\xBF", kAcmi = "filetype=", kStk = "stk.v.";
  const std::string begin =
      lowerCase(std::string(head.substr(beginsWith(head, kMark) ? kMark.size() : 0, 16)));
  if (beginsWith(begin, kAcmi)) return Format::acmi;
  if (head.empty()) return Format::empty;
  for (const std::string_view begin_of : kPackedBegins) {
    if (beginsWith(head, begin_of)) return Format::packed;
  }
  for (const std::string_view magic :
       {"\xA1\xB2\xC3\xD4", "\xD4\xC3\xB2\xA1", "\xA1\xB2\x3C\x4D", "\x4D\x3C\xB2\xA1", "\x0A\x0D\x0D\x0A"}) {
    if (beginsWith(head, magic)) return Format::capture;
  }
  if (isHexLog(head)) return Format::hex_log;
  if (isSession(head)) return Format::session;
  if (beginsWith(begin, kStk)) return Format::stk;
  if (beginsWith(head, "\xFF\xFE") || beginsWith(head, "\xFE\xFF")) return Format::utf16;
  if (isNmea(head)) return Format::nmea;
  const Format markup = markupOf(head);
  if (markup != Format::unknown) return markup;
  if (isAsi(head)) return Format::asi;
  return isTrackTable(head, options) ? Format::table : Format::unknown;
}

/// Tells the progress of reading as the source is read.
class Reporter {
 public:
  Reporter(const ByteSource& source, const std::string& file, const ProgressSink& progress)
      : source_(source), file_(file), progress_(progress) {}

  void operator()() {
    if (!progress_ || source_.fraction() < reported_) return;
    progress_("reading " + file_, source_.fraction());
    reported_ = source_.fraction() + 0.01;
  }

 private:
  const ByteSource& source_;
  const std::string& file_;
  const ProgressSink& progress_;
  double reported_ = 0;
};

Recording readDis(ByteSource& source, Format format, const std::string& file, const ReadOptions& options,
                  const ProgressSink& progress) {
  dis::DisRecorder recorder(options);
  Reporter report(source, file, progress);
  const dis::DatagramSink sink = [&](const dis::Datagram& datagram) {
    report();
    recorder.take(datagram);
  };
  if (format == Format::capture) dis::readCapture(source, recorder.tally(), sink);
  if (format == Format::hex_log) dis::readHexLog(source, recorder.tally(), sink);
  if (format == Format::session) dis::readSession(source, recorder.tally(), sink);
  if (!source.failure().empty()) recorder.tally().torn = source.failure();
  return recorder.finish();
}

/// What a file holds, or the recording in it if it is a zip or gzip file.
std::unique_ptr<ByteSource> unzipped(const Opener& open, const std::string& file) {
  std::array<char, kZipBegin.size()> begin{};
  const std::string_view head(begin.data(), open()->read(begin.data(), begin.size()));
  if (beginsWith(head, kGzipBegin)) return openGzip(open(), file);
  std::vector<std::string> endings = recordingEndings();
  endings.emplace_back(".csv");
  return head == kZipBegin ? openZip(open, file, endings) : open();
}

/// The begin of a file.
std::string headOf(ByteSource& source) {
  std::string head(16384, '\0');
  std::size_t size = 0;
  while (const std::size_t count = source.read(head.data() + size, head.size() - size)) size += count;
  head.resize(size);
  return head;
}

/// Refuses a text whose letters are not in UTF-8: names of its columns could not be told.
void refuseOtherTexts(std::string_view head) {
  const bool is_text = std::none_of(head.begin(), head.end(), [](unsigned char c) { return c < 0x09; });
  if (!is_text || isUtf8(head, true)) return;
  throw Error(
      ErrorCode::bad_input,
      "no recording of a known format, and a text that is not in UTF-8 (but Latin-1, perhaps); convert "
      "it with iconv -f LATIN1 -t UTF-8, or save it so (Excel: CSV UTF-8), and name the columns of a "
      "table (--columns, or 'columns' of a track: time=NAME,latitude=NAME,longitude=NAME,"
      "height=NAME:ft)");
}

Recording readFormat(Format format, const std::unique_ptr<ByteSource>& source, const std::string& file,
                     const ReadOptions& options, const ProgressSink& progress) {
  switch (format) {
    case Format::acmi:
      return readAcmi(*source, file, progress);
    case Format::asi:
      return readAsi(*source, options);
    case Format::cot:
      return readCot(*source, options);
    case Format::gpx:
      return readGpx(*source, file, options);
    case Format::kml:
      return readKml(*source, file, options);
    case Format::stk:
      return readStkEphemeris(*source, file, options);
    case Format::nmea:
      return readNmea(*source, file, options);
    case Format::czml:
      return readCzml(*source, file, options);
    case Format::table:
      return readTrackTable(*source, file, options);
    case Format::utf16:
      throw Error(
          ErrorCode::bad_input,
          "a text in UTF-16; save it in UTF-8 (Excel: CSV UTF-8) or convert it: iconv -f UTF-16 -t UTF-8");
    case Format::packed:
      throw Error(ErrorCode::bad_input,
                  "packed by 7z, xz, bzip2 or zstd, of which none is read; unpack it and give the recording "
                  "in it, or pack it with gzip or zip");
    case Format::empty:
      throw Error(ErrorCode::bad_input, "the file is empty");
    case Format::unknown:
      refuseOtherTexts(headOf(*source));
      throw Error(
          ErrorCode::bad_input,
          "no recording of a known format: ACMI 2.0 to 2.2 (.acmi, .zip.acmi), DIS as .pcap, .pcapng, "
          "hexadecimal log or .session, SIMDIS .asi, Cursor on Target, or tracks as GPX, KML, CZML, STK .e, "
          "NMEA or CSV. Name the columns of a table whose names are not known (--columns, or 'columns' of a "
          "track: time=NAME,latitude=NAME,longitude=NAME,height=NAME:ft). From other programs export one of "
          "these, or record the network with tcpdump -w FILE.pcap udp");
    default:
      return readDis(*source, format, file, options, progress);
  }
}

/// Removes the objects of which no position is known, with their beams.
void dropWithoutPosition(Recording& recording) {
  std::vector<bool> has_position;
  for (const RecordedObject& object : recording.objects) has_position.push_back(!object.poses.empty());
  const auto dropped = std::count(has_position.begin(), has_position.end(), false);
  if (dropped == 0) return;
  keepObjects(recording, has_position);
  recording.tally.notes.push_back(
      fmt::format("{} without a position, left out", countText(dropped, "object", "objects")));
}

Recording readFrom(const Opener& open, const std::string& file, const ReadOptions& options,
                   const ProgressSink& progress) {
  const WorkPart part("reading " + std::filesystem::path(file).filename().string(), 0, 1);
  Recording recording;
  try {
    const std::string head = headOf(*unzipped(open, file));
    const Format format = formatOf(head, options);
    recording = readFormat(format, unzipped(open, file), file, options, progress);
  } catch (const Error& error) {
    if (!error.location().file.empty()) throw;
    throw Error(error.code(), {file, 0, 0}, error.message());
  }
  recording.file = file;
  dropWithoutPosition(recording);
  if (recording.objects.empty()) {
    std::string reason;
    if (recording.tally.bad > 0)
      reason = fmt::format("; {} cannot be read, the first: {}",
                           countText(recording.tally.bad, "record", "records"), recording.tally.first_bad);
    for (const auto& [kind, count] : recording.tally.ignored) {
      if (reason.size() < 300) reason += fmt::format("; {}: not used", kind);
    }
    throw Error(ErrorCode::bad_input, {file, 0, 0}, "the recording has no object with a position" + reason);
  }
  return recording;
}

}  // namespace

const std::vector<std::string>& recordingEndings() {
  static const std::vector<std::string> endings{".acmi", ".pcap", ".pcapng", ".session", ".asi", ".cot",
                                                ".gpx",  ".kml",  ".kmz",    ".czml",    ".e",   ".nmea"};
  return endings;
}

std::string recordingEndingsText() {
  return fmt::format("{}", fmt::join(recordingEndings(), " "));
}

std::unique_ptr<ByteSource> openRecording(const std::string& file) {
  return unzipped([&file] { return openFile(file); }, file);
}

Recording readRecording(const std::string& file, const ReadOptions& options, const ProgressSink& progress) {
  return readFrom([&file] { return openFile(file); }, file, options, progress);
}

Recording readRecordingIn(std::string_view bytes, const std::string& file, const ReadOptions& options) {
  return readFrom([bytes] { return openText(bytes); }, file, options, {});
}

bool isRecording(std::string_view bytes, const ReadOptions& options) {
  if (beginsWith(bytes, kZipBegin) || beginsWith(bytes, kGzipBegin)) return true;
  const Format format = formatOf(bytes.substr(0, 16384), options);
  return format != Format::unknown && format != Format::empty;
}

Recording merged(std::vector<Recording> recordings) {
  if (recordings.size() == 1) return std::move(recordings.front());
  Recording all;
  // A recording of fixed objects alone has no times that could be shifted.
  const auto needsEpoch = [](const Recording& r) {
    const TimeSpan span = spanOf(r);
    return !r.epoch_ms && span.begin_s < span.end_s;
  };
  std::string without;
  for (const Recording& r : recordings) {
    if (needsEpoch(r)) without += (without.empty() ? "" : ", ") + r.file;
    if (r.epoch_ms) all.epoch_ms = std::min(all.epoch_ms.value_or(*r.epoch_ms), *r.epoch_ms);
  }
  if (!without.empty()) {
    all.epoch_ms.reset();
    all.tally.notes.push_back(
        fmt::format("no common epoch, as {} has none: each recording begins at its own t = 0", without));
  }
  for (Recording& recording : recordings) {
    const bool is_shifted = all.epoch_ms && recording.epoch_ms;
    const double shift_s = is_shifted ? static_cast<double>(*recording.epoch_ms - *all.epoch_ms) / 1000 : 0;
    const std::size_t first = all.objects.size();
    for (RecordedObject& object : recording.objects) {
      for (PoseSample& pose : object.poses) pose.t_s += shift_s;
      for (PresenceSample& sample : object.presence) sample.t_s += shift_s;
      all.objects.push_back(std::move(object));
    }
    for (RecordedBeam& beam : recording.beams) {
      for (BeamState& state : beam.states) {
        state.t_s += shift_s;
        if (state.target != kNoTarget) state.target += first;
      }
      beam.object += first;
      all.beams.push_back(std::move(beam));
    }
    const auto join = [](std::string& list, const std::string& item) {
      if (!item.empty() && list.find(item) == std::string::npos) list += (list.empty() ? "" : ", ") + item;
    };
    join(all.file, recording.file);
    join(all.format, recording.format);
    ReadingTally& tally = recording.tally;
    all.tally.records += tally.records;
    all.tally.bad += tally.bad;
    if (all.tally.first_bad.empty()) all.tally.first_bad = tally.first_bad;
    join(all.tally.torn, tally.torn);
    for (const auto& [kind, count] : tally.ignored) all.tally.ignored[kind] += count;
    all.tally.notes.insert(all.tally.notes.end(), tally.notes.begin(), tally.notes.end());
  }
  return all;
}

}  // namespace emscape::interop
