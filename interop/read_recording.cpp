#include "interop/recording/read_recording.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cctype>
#include <filesystem>

#include "base/text/count_text.h"
#include "emscape/base/error.h"
#include "interop/acmi/acmi_reader.h"
#include "interop/dis/dis_recorder.h"

namespace emscape::interop {
namespace {

enum class Format { unknown, acmi, zip, seven_zip, capture, hex_log, session };

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

Format formatOf(std::string_view head) {
  if (beginsWith(head,
                 "\xEF\xBB\xBF"
                 "FileType=") ||
      beginsWith(head, "FileType="))
    return Format::acmi;
  if (beginsWith(head, "PK\x03\x04")) return Format::zip;
  if (beginsWith(head, "7z\xBC\xAF\x27\x1C")) return Format::seven_zip;
  for (const std::string_view magic :
       {"\xA1\xB2\xC3\xD4", "\xD4\xC3\xB2\xA1", "\xA1\xB2\x3C\x4D", "\x4D\x3C\xB2\xA1", "\x0A\x0D\x0D\x0A"}) {
    if (beginsWith(head, magic)) return Format::capture;
  }
  if (isHexLog(head)) return Format::hex_log;
  return isSession(head) ? Format::session : Format::unknown;
}

Recording readDis(ByteSource& source, Format format, const std::string& file, const ReadOptions& options,
                  const ProgressSink& progress) {
  dis::DisRecorder recorder(options);
  double reported = 0;
  const dis::DatagramSink sink = [&](const dis::Datagram& datagram) {
    if (progress && source.fraction() >= reported) {
      progress("reading " + file, source.fraction());
      reported = source.fraction() + 0.01;
    }
    recorder.take(datagram);
  };
  try {
    if (format == Format::capture) dis::readCapture(source, recorder.tally(), sink);
    if (format == Format::hex_log) dis::readHexLog(source, recorder.tally(), sink);
    if (format == Format::session) dis::readSession(source, recorder.tally(), sink);
  } catch (const Error& error) {
    throw Error(error.code(), {file, 0, 0}, error.message());
  }
  if (!source.failure().empty()) recorder.tally().torn = source.failure();
  return recorder.finish();
}

/// Removes the objects of which no position is known, with their beams.
void dropWithoutPosition(Recording& recording) {
  std::vector<std::size_t> kept_as(recording.objects.size());
  std::vector<RecordedObject> objects;
  long long dropped = 0;
  for (std::size_t i = 0; i < recording.objects.size(); ++i) {
    kept_as[i] = objects.size();
    if (recording.objects[i].poses.empty()) {
      kept_as[i] = recording.objects.size();
      ++dropped;
    } else {
      objects.push_back(std::move(recording.objects[i]));
    }
  }
  if (dropped == 0) {
    recording.objects = std::move(objects);
    return;
  }
  std::vector<RecordedBeam> beams;
  for (RecordedBeam& beam : recording.beams) {
    if (kept_as[beam.object] == recording.objects.size()) continue;
    beam.object = kept_as[beam.object];
    for (BeamState& state : beam.states) {
      if (state.target == kNoTarget) continue;
      const bool is_kept = kept_as[state.target] != recording.objects.size();
      state.target = is_kept ? kept_as[state.target] : kNoTarget;
    }
    beams.push_back(std::move(beam));
  }
  recording.objects = std::move(objects);
  recording.beams = std::move(beams);
  recording.tally.notes.push_back(
      fmt::format("{} without a position, left out", countText(dropped, "object", "objects")));
}

}  // namespace

Recording readRecording(const std::string& file, const ReadOptions& options, const ProgressSink& progress) {
  std::array<char, 16384> head{};
  const std::size_t size = openFile(file)->read(head.data(), head.size());
  const Format format = formatOf({head.data(), size});
  Recording recording;
  switch (format) {
    case Format::acmi:
      recording = readAcmi(*openFile(file), file, progress);
      break;
    case Format::zip:
      recording = readAcmi(*openZip(file), file, progress);
      break;
    case Format::seven_zip:
      throw Error(ErrorCode::bad_input, {file, 0, 0},
                  "a 7z archive; unpack it with 7z x and give the recording in it");
    case Format::unknown:
      throw Error(
          ErrorCode::bad_input, {file, 0, 0},
          "no recording of a known format: ACMI 2.0 to 2.2 (.acmi, .zip.acmi), DIS as .pcap, .pcapng, "
          "hexadecimal log or .session. From other programs export one of these, or record the network "
          "with tcpdump -w FILE.pcap udp");
    default:
      recording = readDis(*openFile(file), format, file, options, progress);
  }
  recording.file = file;
  dropWithoutPosition(recording);
  if (recording.objects.empty()) {
    std::string reason;
    if (recording.tally.bad > 0)
      reason = fmt::format("; {} cannot be read, the first: {}",
                           countText(recording.tally.bad, "record", "records"), recording.tally.first_bad);
    throw Error(ErrorCode::bad_input, {file, 0, 0}, "the recording has no object with a position" + reason);
  }
  return recording;
}

Recording merged(std::vector<Recording> recordings) {
  if (recordings.size() == 1) return std::move(recordings.front());
  Recording all;
  const bool have_epochs = std::all_of(recordings.begin(), recordings.end(),
                                       [](const Recording& r) { return r.epoch_ms.has_value(); });
  if (have_epochs) {
    for (const Recording& r : recordings)
      all.epoch_ms = std::min(all.epoch_ms.value_or(*r.epoch_ms), *r.epoch_ms);
  }
  for (Recording& recording : recordings) {
    const double shift_s = have_epochs ? static_cast<double>(*recording.epoch_ms - *all.epoch_ms) / 1000 : 0;
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
