#include <algorithm>
#include <cmath>

#include "recording/dis/big_endian.h"
#include "recording/dis/pdu.h"

namespace emscape::interop::dis {
namespace {

bool isFinite(const Vec3d& v) {
  return std::isfinite(v.x) && std::isfinite(v.y) && std::isfinite(v.z);
}

EntityId entityId(BigEndianReader& reader) {
  EntityId id;
  id.site = reader.u16();
  id.application = reader.u16();
  id.entity = reader.u16();
  return id;
}

std::array<int, 7> entityType(BigEndianReader& reader) {
  std::array<int, 7> type{};
  type[0] = reader.u8();
  type[1] = reader.u8();
  type[2] = reader.u16();
  for (std::size_t i = 3; i < 7; ++i) type[i] = reader.u8();
  return type;
}

constexpr std::size_t kSystemBytes = 20, kBeamBytes = 52, kTargetBytes = 8;

EmissionBeam emissionBeam(BigEndianReader& reader, std::uint8_t version) {
  EmissionBeam beam;
  reader.skip(1);  // its length: written in bytes by some, and not needed
  beam.number = reader.u8();
  beam.parameter_index = reader.u16();
  beam.frequency_hz = reader.f32();
  beam.frequency_range_hz = reader.f32();
  beam.erp_dbm = reader.f32();
  beam.prf_hz = reader.f32();
  beam.pulse_width_us = reader.f32();
  beam.azimuth_rad = reader.f32();
  beam.azimuth_sweep_rad = reader.f32();
  beam.elevation_rad = reader.f32();
  beam.elevation_sweep_rad = reader.f32();
  reader.f32();  // percentage of the sweep
  beam.function = reader.u8();
  const std::size_t targets = reader.u8();
  reader.u8();  // high density of tracks
  const std::uint8_t status = reader.u8();
  beam.is_off = version >= 7 && (status & 1) != 0;
  reader.skip(4);  // jamming technique
  for (std::size_t i = 0; i < targets && reader.left() >= kTargetBytes; ++i) {
    beam.targets.push_back(entityId(reader));
    reader.skip(2);  // emitter and beam
  }
  if (beam.targets.size() < targets) reader.skip(kTargetBytes);  // not sound
  return beam;
}

void readBody(BigEndianReader& reader, std::uint8_t, EntityState& state) {
  state.id = entityId(reader);
  state.force = reader.u8();
  reader.skip(1);  // articulation parameters, at the end
  state.type = entityType(reader);
  reader.skip(8);  // alternative type
  state.velocity_mps = reader.floats();
  state.position_m = reader.doubles();
  state.orientation_rad = reader.floats();
  state.appearance = reader.u32();
  state.algorithm = reader.u8();
  reader.skip(15);
  state.acceleration_mps2 = reader.floats();
  state.turn_radps = reader.floats();
  reader.skip(1);  // character set
  for (std::size_t i = 0; i < kMarkingBytes; ++i) state.marking += static_cast<char>(reader.u8());
  state.marking.resize(std::min(state.marking.find('\0'), state.marking.size()));
  reader.u32();  // capabilities
}

void readBody(BigEndianReader& reader, std::uint8_t version, Emission& emission) {
  emission.entity = entityId(reader);
  reader.skip(4);  // site and application of the event
  emission.event = reader.u16();
  emission.is_change = reader.u8() != 0;
  const std::size_t systems = reader.u8();
  reader.skip(2);
  for (std::size_t i = 0; i < systems && reader.left() >= kSystemBytes; ++i) {
    EmissionSystem system;
    reader.skip(1);
    const std::size_t beams = reader.u8();
    reader.skip(2);
    system.name = reader.u16();
    system.function = reader.u8();
    system.number = reader.u8();
    system.location_m = reader.floats();
    for (std::size_t b = 0; b < beams && reader.left() >= kBeamBytes; ++b)
      system.beams.push_back(emissionBeam(reader, version));
    if (system.beams.size() < beams) reader.skip(kMaxPduBytes);  // not sound
    emission.systems.push_back(std::move(system));
  }
  if (emission.systems.size() < systems) reader.skip(kMaxPduBytes);  // not sound
}

void readBody(BigEndianReader& reader, std::uint8_t, Transmitter& transmitter) {
  transmitter.entity = entityId(reader);
  transmitter.radio = reader.u16();
  transmitter.type = entityType(reader);
  transmitter.state = reader.u8();
  reader.skip(3);  // source; count of variable parameters (version 7), at the end
  transmitter.antenna_m = reader.doubles();
  transmitter.relative_antenna_m = reader.floats();
  transmitter.antenna_pattern = reader.u16();
  reader.skip(2);  // length of the antenna pattern, at the end
  transmitter.frequency_hz = reader.u64();
  transmitter.bandwidth_hz = reader.f32();
  transmitter.power_dbm = reader.f32();
  for (std::uint16_t& modulation : transmitter.modulation) modulation = reader.u16();
  reader.skip(8);  // crypto system and key, length of the modulation parameters, padding
}

/// The body of a PDU. The fault, if there is one: "WHAT of N bytesREASON".
template <class Pdu>
std::optional<Pdu> decodeBody(const std::uint8_t* bytes, std::size_t size, const std::string& what,
                              const std::string& reason, std::string& fault) {
  BigEndianReader reader(bytes, size);
  const std::uint8_t version = reader.u8();
  reader.skip(kHeaderBytes - 1);
  Pdu pdu;
  readBody(reader, version, pdu);
  if (reader.isSound()) return pdu;
  fault = what + " of " + std::to_string(size) + " bytes" + reason;
  return std::nullopt;
}

}  // namespace

std::string nameOf(std::uint8_t type) {
  switch (static_cast<PduType>(type)) {
    case PduType::entity_state:
      return "Entity State";
    case PduType::emission:
      return "Electromagnetic Emission";
    case PduType::designator:
      return "Designator";
    case PduType::transmitter:
      return "Transmitter";
    case PduType::signal:
      return "Signal";
    case PduType::receiver:
      return "Receiver";
    case PduType::iff:
      return "IFF";
  }
  return "type " + std::to_string(type);
}

std::optional<Header> decodeHeader(const std::uint8_t* bytes, std::size_t size) {
  if (size < kHeaderBytes) return std::nullopt;
  BigEndianReader reader(bytes, size);
  Header header;
  header.version = reader.u8();
  header.exercise = reader.u8();
  header.type = reader.u8();
  reader.skip(1);  // family
  header.timestamp = reader.u32();
  header.length = reader.u16();
  const bool is_pdu = header.version >= 1 && header.version <= 7 && header.length >= kHeaderBytes &&
                      header.length <= std::min(size, kMaxPduBytes);
  return is_pdu ? std::optional(header) : std::nullopt;
}

std::optional<EntityState> decodeEntityState(const std::uint8_t* bytes, std::size_t size,
                                             std::string& fault) {
  auto state = decodeBody<EntityState>(bytes, size, "an Entity State PDU", "; it has at least 144", fault);
  if (!state) return state;
  const double radius_m = length(state->position_m);
  const bool is_sound = radius_m > 6.2e6 && radius_m < 5e7 && isFinite(state->velocity_mps) &&
                        isFinite(state->orientation_rad) && isFinite(state->acceleration_mps2) &&
                        isFinite(state->turn_radps);
  if (is_sound) return state;
  fault = "an Entity State PDU whose position is not near the earth, or that has values that are no numbers";
  return std::nullopt;
}

std::optional<Emission> decodeEmission(const std::uint8_t* bytes, std::size_t size, std::string& fault) {
  return decodeBody<Emission>(bytes, size, "an Electromagnetic Emission PDU",
                              " that counts more systems, beams or targets than they hold", fault);
}

std::optional<Transmitter> decodeTransmitter(const std::uint8_t* bytes, std::size_t size,
                                             std::string& fault) {
  return decodeBody<Transmitter>(bytes, size, "a Transmitter PDU", "; it has at least 104", fault);
}

}  // namespace emscape::interop::dis
