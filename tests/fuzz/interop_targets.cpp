// Recordings of other programs, and databases of emitters.
#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "emscape/scenario/file/scenario_file.h"
#include "emscape/scenario/model/poses.h"
#include "interop/emitters/emitter_database.h"
#include "interop/emitters/emitter_names.h"
#include "interop/export_scenario.h"
#include "interop/import_scenario.h"
#include "interop/live/live_acmi.h"
#include "interop/live/live_cot.h"
#include "interop/live/live_dis.h"
#include "recording/acmi/acmi_reader.h"
#include "recording/cot/cot_reader.h"
#include "recording/dis/datagrams.h"
#include "recording/dis/dis_recorder.h"
#include "recording/read_recording.h"
#include "scenario/model/posed_platform.h"
#include "tests/fuzz/fuzz_target.h"
#include "tests/support/files.h"
#include "tests/support/temporary_folder.h"

namespace emscape::test {
namespace {

namespace fs = std::filesystem;

/// A short scenario as a recording.
std::string recordingOf(const std::string& ending) {
  const TemporaryFolder folder;
  const std::string file = folder / ("a" + ending);
  const auto scenario = scenario::loadScenario(shippedScenario("jamming.yaml"), {{"duration_s", "4"}},
                                               scenario::ReadFor::chosen_times);
  interop::ExportOptions options;
  options.step_s = 2;
  interop::exportScenario(scenario, nullptr, file, options);
  return readFile(file);
}

/// The bytes after the headers of a capture's packets: PDUs, one after another.
std::vector<std::string> pdus() {
  const std::string capture = recordingOf(".pcap");
  const auto source = interop::openText(capture);
  interop::ReadingTally tally;
  std::vector<std::string> all;
  interop::dis::readCapture(*source, tally, [&](const interop::dis::Datagram& datagram) {
    all.emplace_back(reinterpret_cast<const char*>(datagram.bytes), datagram.size);
  });
  return all;
}

std::string bigEndian(std::uint64_t value, int bytes) {
  std::string text;
  for (int i = bytes - 1; i >= 0; --i) text += static_cast<char>(value >> (8 * i));
  return text;
}

void readRecordingFile(const fs::path& file, const std::string&) {
  const interop::Recording recording = interop::readRecording(file);
  checkFuzzMessage(recording.tally.first_bad);
  checkFuzzMessage(recording.tally.torn);
  for (const auto& [kind, count] : recording.tally.ignored) checkFuzzMessage(kind);
  for (const interop::RecordedObject& object : recording.objects) checkFuzzMessage(object.name);
}

/// An emitter for every object, so that objects without beams become scenarios, too.
void writeDatabaseForAll(const fs::path& folder) {
  writeFile(folder / "all.yaml",
            "schema_version: 1\nemitters:\n  - match: {object_name: \"*\"}\n    emitter: {kind: transmitter, "
            "frequency_hz: 1.0e9, power_w: 1, antenna: {pattern: isotropic}}\n");
}

/// Whatever a recording has, the scenario that is written of it is valid.
void importRecordingFile(const fs::path& file, const std::string&) {
  interop::ImportOptions options;
  options.scenario = file.parent_path() / "out.yaml";
  options.replace = true;
  const fs::path database = file.parent_path() / "all.yaml";
  if (!fs::exists(database)) writeDatabaseForAll(file.parent_path());
  options.emitters = database;
  interop::importRecording(interop::readRecording(file), options);
  for (const scenario::Problem& problem : scenario::parseScenario(options.scenario).problems) {
    if (problem.severity == scenario::Severity::error)
      throw std::logic_error("the imported scenario is not valid: " + problem.message);
  }
  fs::remove_all(file.parent_path() / "out_tracks");
}

/// A live stream in pieces of the size that its first byte tells; then all that is asked of its state.
void takeStream(interop::LiveState& live, const std::string& bytes) {
  if (bytes.empty()) return;
  const auto* const data = reinterpret_cast<const std::uint8_t*>(bytes.data());
  const std::size_t piece = data[0] == 0 ? bytes.size() : 16 * std::size_t{data[0]};
  double time_s = 0;
  for (std::size_t at = 1; at < bytes.size(); at += piece, time_s += 0.5)
    live.take(data + at, std::min(piece, bytes.size() - at), time_s);
  live.expire(time_s);
  const interop::LiveRecording now = live.recording(time_s);
  if (now.keys.size() != now.recording.objects.size() || now.keys.size() > interop::LiveLimits::kObjects ||
      now.keys.size() != live.objectCount() || now.keys.size() > live.poses(time_s).size())
    throw std::logic_error("the live state has other objects than its recording");
  for (const interop::RecordedBeam& beam : now.recording.beams) {
    if (beam.object >= now.keys.size()) throw std::logic_error("a beam of no object");
  }
  for (const interop::LivePose& at : live.poses(time_s + 5)) {
    const std::string fault = scenario::poseFault(
        scenario::positionMsl(at.pose.latitude_deg, at.pose.longitude_deg, at.pose.height_msl_m),
        {at.pose.heading_deg, at.pose.pitch_deg, at.pose.roll_deg});
    if (!fault.empty()) throw std::logic_error("a pose that cannot be shown: " + fault);
  }
  checkFuzzMessage(live.counts().first_bad);
  live.expire(time_s + 20);
}

const FuzzTargetsAdded added({
    {"acmi", "input.acmi", readRecordingFile,
     [] {
       return std::vector<std::string>{
           recordingOf(".acmi"),
           "FileType=text/acmi/"
           "tacview\nFileVersion=2.1\n0,ReferenceLongitude=5,ReferenceTime=2020-01-01T00:00:00Z\n"
           "1,T=1|2|3|4|5|6|7|8|9,Name=a\\, b,Color=Red\n#-1\n1,T=||,Visible=0\n0,Event=Destroyed|1|\n-1\n"};
     }},
    {"acmi_zip", "input.zip.acmi", readRecordingFile,
     [] { return std::vector<std::string>{recordingOf(".zip.acmi")}; }},
    {"capture", "input.pcap", readRecordingFile,
     [] { return std::vector<std::string>{recordingOf(".pcap")}; }},
    {"hex_log", "input.log", readRecordingFile,
     [] {
       std::string log;
       for (const std::string& pdu : pdus()) {
         log += "0\n";
         for (const char c : pdu) {
           const char digits[] = "0123456789abcdef";
           const auto byte = static_cast<unsigned char>(c);
           log += {digits[byte >> 4], digits[byte & 15], ' '};
         }
         log += "\n";
       }
       return std::vector<std::string>{log};
     }},
    {"dis_session", "input.session", readRecordingFile,
     [] {
       std::string session;
       for (const std::string& pdu : pdus()) session += bigEndian(1000, 8) + bigEndian(pdu.size(), 2) + pdu;
       return std::vector<std::string>{session};
     }},
    {"dis_datagram", "",
     [](const fs::path&, const std::string& bytes) {
       interop::dis::DisRecorder recorder{interop::ReadOptions{}};
       recorder.take({0, reinterpret_cast<const std::uint8_t*>(bytes.data()), bytes.size()});
       recorder.take({1, reinterpret_cast<const std::uint8_t*>(bytes.data()), bytes.size()});
       checkFuzzMessage(recorder.finish().tally.first_bad);
     },
     pdus},
    {"dis_stream", "",
     [](const fs::path&, const std::string& bytes) {
       interop::LiveDis live{interop::ReadOptions{}};
       takeStream(live, bytes);
     },
     [] {
       std::string bundle(1, '\0');
       std::vector<std::string> seeds;
       for (const std::string& pdu : pdus()) {
         seeds.push_back(std::string(1, '\0') + pdu);
         if (bundle.size() < 8000) bundle += pdu;
       }
       seeds.push_back(bundle);
       return seeds;
     }},
    {"acmi_stream", "",
     [](const fs::path&, const std::string& bytes) {
       interop::LiveAcmi live;
       takeStream(live, bytes);
     },
     [] { return std::vector<std::string>{std::string(1, '\x05') + recordingOf(".acmi")}; }},
    {"asi", "input.asi", importRecordingFile,
     [] {
       return std::vector<std::string>{
           recordingOf(".asi"),
           "ReferenceYear 2012\nDegreeAngles 0\nCoordSystem \"ECEF\"\nPlatformID 1\nPlatformType 1 ship\n"
           "PlatformData 1 -1 3872000 338000 5004000 1 2 3 0 0 0\nPlatformID 2\nPlatformCoordSystem 2 LLA\n"
           "PlatformData 2 \"001 2012 00:01:40\" 52 5 50 0 0 0 0 0 0\nBeamID 1 9\nBeamType 9 TARGET\n"
           "BeamTargetIDCmd 9 100 2\nBeamOnOffCmd 9 101 0\nBeamID 2 8\nBeamDataRAE 8 100 1 0.1 99\n"};
     }},
    {"cot", "input.cot", importRecordingFile, [] { return std::vector<std::string>{recordingOf(".cot")}; }},
    {"kml", "input.kml", importRecordingFile,
     [] {
       return std::vector<std::string>{
           recordingOf(".kml"),
           "<kml><Placemark><name>a</name><TimeStamp><when>2026-06-01T06:00:00Z</when></TimeStamp><Point>"
           "<coordinates>5,52,9</coordinates></Point></Placemark></kml>"};
     }},
    {"czml", "input.czml", importRecordingFile,
     [] {
       return std::vector<std::string>{
           recordingOf(".czml"),
           "[{\"id\":\"a\",\"availability\":[\"2026-06-01T06:00:00Z/2026-06-01T06:01:00Z\"],\"position\":"
           "{\"epoch\":\"2026-06-01T06:00:00Z\",\"interpolationAlgorithm\":\"LAGRANGE\","
           "\"interpolationDegree\""
           ":3,\"cartesian\":[0,3872000,338000,5004000,9,3872000,338900,5004000,20,3872000,339999,5004000]}}"
           "]"};
     }},
    {"gpx", "input.gpx", importRecordingFile,
     [] {
       return std::vector<std::string>{
           "<gpx><wpt lat='52' lon='5'><name>m</name></wpt><trk><trkseg><trkpt lat='52' lon='5'><ele>9</ele>"
           "<time>2026-06-01T06:00:00Z</time></trkpt><trkpt lat='52' "
           "lon='5.1'><time>2026-06-01T08:00:09+02:00"
           "</time></trkpt></trkseg></trk></gpx>"};
     }},
    {"stk_ephemeris", "input.e", importRecordingFile,
     [] {
       return std::vector<std::string>{
           "stk.v.4.3\nBEGIN Ephemeris\nScenarioEpoch 1 Jun 2026 06:00:00.0\nInterpolationOrder "
           "5\nCentralBody "
           "Earth\nCoordinateSystem Fixed\nDistanceUnit Kilometers\nEphemerisTimePos\n0 3872 338 5004\n10 "
           "3872 339 "
           "5004\n20 3871 341 5004\nEND Ephemeris\n",
           "stk.v.11.0\nEphemerisLLATimePos\n0 52 5 100\n9 52.1 5 200\n"};
     }},
    {"nmea", "input.nmea", importRecordingFile,
     [] {
       return std::vector<std::string>{
           "$GPGGA,235958,5200.000,N,00500.000,E,1,8,1.0,12.5,M,46.0,M,,\n$GPRMC,235958,A,5200.000,N,00500."
           "000,E,10.0,"
           "90.0,310526,,\n$GPZDA,000002,01,06,2026,00,00\n$GPGNS,000002,5200.1,N,00500.1,E,AA,8,1,13,46,,"
           "\n"};
     }},
    {"track_table", "input.csv", importRecordingFile,
     [] {
       return std::vector<std::string>{
           "time,icao24,lat,lon,heading,baroaltitude,geoaltitude\n1748000000,a,52,5,31,3000,3052\n1748000009,"
           "a,52.1,5,,"
           "3000,\n",
           "t_s;Lat (deg);lon;altitude_ft\n0;52,5;5,1;1000\n9;52,6;5,1;1000\n"};
     }},
    {"cot_stream", "",
     [](const fs::path&, const std::string& bytes) {
       interop::CotReader reader{interop::ReadOptions{}};
       interop::CotSplitter splitter;
       // Two halves, as a stream may bring them.
       for (const std::string& part : {bytes.substr(0, bytes.size() / 2), bytes.substr(bytes.size() / 2)})
         splitter.take(part, [&](std::string_view event) { reader.takeEvent(event); });
       checkFuzzMessage(reader.finish().tally.first_bad);
     },
     [] { return std::vector<std::string>{recordingOf(".cot")}; }},
    {"cot_live", "",
     [](const fs::path&, const std::string& bytes) {
       for (const bool is_text : {true, false}) {
         interop::LiveCot live(is_text);
         for (const std::string& part :
              {bytes.substr(0, bytes.size() / 2), bytes.substr(bytes.size() / 2), bytes})
           live.take(reinterpret_cast<const std::uint8_t*>(part.data()), part.size(), 0);
         const interop::LiveRecording now = live.recording(1);
         if (now.keys.size() != now.recording.objects.size() || live.poses(1).size() < now.keys.size())
           std::abort();
         checkFuzzMessage(live.counts().first_bad);
         live.expire(1e9);
         if (live.objectCount() != 0) std::abort();
       }
     },
     [] { return std::vector<std::string>{recordingOf(".cot")}; }},
    {"emitter_names", "input.xml",
     [](const fs::path& file, const std::string&) { interop::readEmitterNames(file); },
     [] {
       return std::vector<std::string>{
           "<ebv><enum uid=\"75\"><enumrow value=\"3\" description=\"AN/SPS-49\"/></enum></ebv>"};
     }},
    {"import_acmi", "input.acmi", importRecordingFile,
     [] {
       return std::vector<std::string>{
           recordingOf(".acmi"),
           "FileType=text/acmi/tacview\nFileVersion=2.2\n1,T=5|52|10|0|0|90,Type=Sea+Watercraft,Name=Boat\n"
           "2,T=5|52|3000,Type=Air+FixedWing,Name=F-14B,RadarMode=1,RadarAzimuth=5,RadarHorizontalBeamwidth="
           "3\n"
           "#10\n1,T=5.01|52\n2,T=5.1|52.1,RadarAzimuth=50,LockedTarget=1,LockedTargetMode=1\n#30\n2,"
           "RadarMode=0\n-1\n"};
     }},
    {"import_capture", "input.pcap", importRecordingFile,
     [] { return std::vector<std::string>{recordingOf(".pcap")}; }},
    {"emitter_database",
     "",
     [](const fs::path&, const std::string& text) { interop::parseEmitterDatabase("input.yaml", text); },
     [] {
       return std::vector<std::string>{
           interop::kStarterEmitters,
           "schema_version: 1\nunmatched: default\ndefault: {kind: transmitter}\n"};
     },
     {},
     interop::emitterDatabaseJsonSchema},
    {"import_region", "", [](const fs::path&, const std::string& text) { interop::parseRegion(text); },
     [] { return std::vector<std::string>{"36.3,-84.2,80"}; }},
});

}  // namespace
}  // namespace emscape::test
