/// A battlefield that another program streams, as a scenario and poses of its platforms.
#pragma once

#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "emscape/base/progress.h"
#include "interop/import_scenario.h"
#include "playback/sockets/address.h"
#include "playback/stream/named_poses.h"
#include "recording/read_recording.h"

namespace emscape::playback {

enum class StreamKind { dis, acmi, cot };

/// The words of a kind of stream, and the rules of its transport.
struct StreamFormat {
  const char* name;
  const char* ending;           ///< of its recordings
  const char *record, *plural;  ///< what it consists of
  const char *object, *objects;
  double silence_s;  ///< after which it has stopped
};
const StreamFormat& formatOf(StreamKind kind);

struct StreamRequest {
  StreamKind kind = StreamKind::dis;
  bool connects = false;        ///< by TCP; else it listens for datagrams
  Address address;              ///< to listen to, or to connect to
  std::uint32_t interface = 0;  ///< on which a multicast group is joined
  std::string password;         ///< of an ACMI host; empty: none
  interop::ReadOptions read;
  interop::BeamwidthMeaning beamwidth = interop::BeamwidthMeaning::by_size;
  std::string base;                ///< scenario with region, terrain and further platforms
  std::string emitters;            ///< emitter database; empty: the starter set
  std::string record;              ///< file for what arrives, .pcap, .acmi or .cot; empty: none
  bool replaces = false;           ///< files that exist; else they are an error
  std::string folder;              ///< of the scenario file; empty: a temporary one
  const StopFlag* stop = nullptr;  ///< ends the waiting for a host; may be null
};

/// What has arrived so far.
struct StreamStatus {
  long long records = 0;  ///< PDUs, lines or events
  long long bytes = 0, bad = 0, late = 0, duplicates = 0;
  long long outside = 0;    ///< positions that are too high or too low, which are not used
  long long lost = 0;       ///< datagrams that the system dropped
  long long forgotten = 0;  ///< objects and beams beyond the limits
  std::size_t entities = 0, emitters = 0;
  /// Platforms of the base that the stream no longer tells of, or as destroyed; those that it never told of.
  std::vector<std::string> silent, untold;
  int unmatched = 0;            ///< beams that no row of the emitter database matches
  double records_per_s = 0;     ///< of the last second or two
  std::optional<double> age_s;  ///< of the last record; none: none came
  std::string trouble;          ///< one line: what is wrong with the stream now; empty: nothing

  /// "DIS: 120 PDU/s, 14 entities, last 0.1 s ago", and the trouble.
  std::string text() const;
  StreamKind kind = StreamKind::dis;
};

/// The battlefield at one instant.
struct BattlefieldNow {
  std::shared_ptr<const scenario::Scenario> scenario;  ///< without the poses; another object: other platforms
  NamedPosesPtr poses;                                 ///< the same object as before if nothing has moved
  double arrival_s = 0;                                ///< of the last record in it (steady clock)
  bool has_stopped = false;                            ///< no record came for StreamFormat::silence_s
};

/// Receives a stream on a thread of its own and keeps the present battlefield.
///
/// Objects become platforms of the base scenario, with emitters by the database, as `import` does. An object
/// with the name of a platform of the base moves that platform instead, whose emitters are those of the base.
/// Where the stream tells of it no more, it stays where it was last, and its emitters are silent; until the
/// stream first tells of it, it is as in the base.
/// When objects or beams change, the scenario is made anew on another thread, at most twice a second;
/// between, only the poses change. Memory and work are bounded whatever arrives (interop::LiveLimits).
class LiveBattlefield {
 public:
  /// @param wake  called on a thread of this object when something has changed, at most 60 times a second
  /// @throws Error (usage, bad_input, other): the address cannot be used, the base or the database has
  /// faults, the recording exists
  LiveBattlefield(const StreamRequest& request, std::function<void()> wake);
  /// Ends within a fraction of a second, and completes the recording.
  ~LiveBattlefield();
  LiveBattlefield(const LiveBattlefield&) = delete;
  LiveBattlefield& operator=(const LiveBattlefield&) = delete;

  /// Another function to call, until another one is set or the result is destroyed, which waits until its
  /// last call has ended. The result must not outlive this object.
  std::shared_ptr<void> setWake(std::function<void()> wake);

  /// As of the last sixtieth of a second; where platforms move by dead reckoning, of the last thirtieth.
  BattlefieldNow now() const;
  StreamStatus status() const;
  /// File of the scenario, without the poses: the base at first.
  std::string file() const;
  /// Completes the recording. @throws Error (other)
  void finishRecording();

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace emscape::playback
