/// PDUs as a recording.
#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <unordered_map>
#include <utility>

#include "recording/common/read_options.h"
#include "recording/common/recording.h"
#include "recording/dis/datagrams.h"
#include "recording/dis/orientation.h"
#include "recording/dis/pdu.h"
#include "recording/dis/sender_clock.h"

namespace emscape::interop::dis {

/// Position and attitude as recordings have them; none if the height is outside of PositionLimits.
std::optional<PoseSample> poseSampleOf(const Vec3d& position_m, const BodyAxes& axes);

/// Takes datagrams in the order of their arrival and keeps what a recording needs of their PDUs.
class DisRecorder {
 public:
  explicit DisRecorder(const ReadOptions& options) : options_(options) {}

  void take(const Datagram& datagram);
  /// The same of a decoded PDU. @param time_s  of the recording
  void takeState(const EntityState& state, double time_s);
  void takeEmission(const Emission& emission, double time_s, int version);
  void takeTransmitter(const Transmitter& transmitter, double time_s);
  /// Call once.
  Recording finish();
  ReadingTally& tally() { return recording_.tally; }

 private:
  struct Entity {
    std::size_t object = 0;
    bool is_known = false;  ///< a state was received
    EntityState state;
    double time_s = 0;  ///< of the state
  };
  struct Beam {
    std::size_t beam = 0;
    double time_s = 0;  ///< of the last update
  };
  /// Beams of one system (or the radio) of an entity, by number.
  using System = std::unordered_map<int, Beam>;

  void takePdu(const Header& header, const std::uint8_t* bytes, double arrival_s);
  void fillGap(const Entity& before, const EntityState& state, double time_s);
  void addPose(Entity& entity, const Vec3d& position_m, const BodyAxes& axes, double time_s);
  void setState(Beam& beam, const BeamState& state);
  void switchOff(Beam& beam, double time_s);
  Entity& entityOf(const EntityId& id);
  /// @param system  number of the system; -1 - radio for a transmitter
  System& systemOf(const EntityId& id, int system) { return systems_[id.key()][system]; }
  Beam& beamOf(const EntityId& id, int system, int number);
  /// The number of an emitter name, with the name where it is known.
  std::string emitterText(int name) const;
  void countSample();

  ReadOptions options_;
  Recording recording_;
  SenderClocks clocks_;
  std::unordered_map<std::uint64_t, Entity> entities_;
  std::unordered_map<std::uint64_t, std::unordered_map<int, System>> systems_;
  bool has_begun_ = false;
  double origin_s_ = 0;  ///< arrival that is t = 0
  double last_s_ = 0;
  int lowest_version_ = 255, highest_version_ = 0;
  std::size_t samples_ = 0, beams_ = 0;
  long long late_ = 0, watts_ = 0, no_power_ = 0;
  std::optional<int> exercise_ = options_.exercise;
  std::map<int, long long> other_exercises_;  ///< PDUs of them
};

}  // namespace emscape::interop::dis
