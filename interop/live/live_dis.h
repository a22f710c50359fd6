/// The present state of a DIS exercise.
#pragma once

#include <list>
#include <map>
#include <optional>
#include <unordered_map>

#include "interop/live/live_state.h"
#include "recording/dis/pdu.h"
#include "recording/dis/sender_clock.h"
#include "recording/read_recording.h"

namespace emscape::interop {

/// Keeps the last state of each entity, of its emitter systems and of its radios. The rules of versions,
/// time-outs and sender's clocks are those of readRecording().
class LiveDis : public LiveState {
 public:
  explicit LiveDis(const ReadOptions& options) : options_(options) {}

  /// @param bytes  a datagram: PDUs, one after another
  void take(const std::uint8_t* bytes, std::size_t size, double arrival_s) override;
  void expire(double now_s) override;
  LiveRecording recording(double now_s) override;
  std::vector<LivePose> poses(double now_s) const override;
  std::size_t objectCount() const override { return known_; }

 private:
  struct System {
    dis::EmissionSystem told;
    double heard_s = 0;
  };
  struct Radio {
    dis::Transmitter told;
    double heard_s = 0;
  };
  struct Entity {
    bool is_known = false;  ///< a state was received; emissions may come before
    dis::EntityState state;
    double time_s = 0;  ///< of the state
    double heard_s = 0;
    std::map<int, System> systems;
    std::map<int, Radio> radios;
    std::list<std::uint64_t>::iterator recent;
  };

  void takePdu(const dis::Header& header, const std::uint8_t* bytes, double arrival_s);
  void takeState(dis::EntityState state, double time_s, double arrival_s);
  void takeEmission(const dis::Emission& emission, int version, double arrival_s);
  void takeTransmitter(const dis::Transmitter& transmitter, double arrival_s);
  Entity& entityOf(const dis::EntityId& id, double arrival_s);
  void forget(std::uint64_t key);
  static std::size_t beamCount(const Entity& entity);
  PoseSample poseOf(const Entity& entity, double now_s) const;

  ReadOptions options_;
  dis::SenderClocks clocks_;
  std::unordered_map<std::uint64_t, Entity> entities_;
  std::list<std::uint64_t> recent_;  ///< keys, the last heard of first
  std::size_t known_ = 0, beams_ = 0;
  double held_beams_changed_s_ = -1e18;
  std::optional<int> exercise_ = options_.exercise;  ///< until nothing of it is heard for a time
  double exercise_heard_s_ = 0;
};

}  // namespace emscape::interop
