#include <stdexcept>

#include "recording/dis/big_endian.h"
#include "recording/dis/pdu.h"

namespace emscape::interop::dis {
namespace {

// Protocol families.
constexpr std::uint8_t kEntityInformation = 1, kRadioCommunications = 4, kEmissionRegeneration = 6;

void writeHeader(BigEndianWriter& writer, const Header& header, PduType type, std::uint8_t family) {
  writer.u8(header.version);
  writer.u8(header.exercise);
  writer.u8(static_cast<std::uint8_t>(type));
  writer.u8(family);
  writer.u32(header.timestamp);
  writer.zeros(4);  // the length, and status and padding
}

void writeId(BigEndianWriter& writer, const EntityId& id) {
  writer.u16(id.site);
  writer.u16(id.application);
  writer.u16(id.entity);
}

void writeType(BigEndianWriter& writer, const std::array<int, 7>& type) {
  writer.u8(static_cast<std::uint8_t>(type[0]));
  writer.u8(static_cast<std::uint8_t>(type[1]));
  writer.u16(static_cast<std::uint16_t>(type[2]));
  for (std::size_t i = 3; i < 7; ++i) writer.u8(static_cast<std::uint8_t>(type[i]));
}

std::vector<std::uint8_t> finished(BigEndianWriter& writer) {
  std::vector<std::uint8_t> bytes = std::move(writer.bytes());
  if (bytes.size() > kMaxPduBytes) throw std::length_error("a PDU of more than 8192 bytes");
  bytes[8] = static_cast<std::uint8_t>(bytes.size() >> 8);
  bytes[9] = static_cast<std::uint8_t>(bytes.size() & 0xFF);
  return bytes;
}

/// A length in 32-bit words; 0 if it does not fit into a byte.
std::uint8_t words(std::size_t bytes) {
  return bytes / 4 > 255 ? 0 : static_cast<std::uint8_t>(bytes / 4);
}

void writeBeam(BigEndianWriter& writer, const EmissionBeam& beam, std::uint8_t version) {
  writer.u8(words(52 + 8 * beam.targets.size()));
  writer.u8(beam.number);
  writer.u16(beam.parameter_index);
  writer.f32(beam.frequency_hz);
  writer.f32(beam.frequency_range_hz);
  writer.f32(beam.erp_dbm);
  writer.f32(beam.prf_hz);
  writer.f32(beam.pulse_width_us);
  writer.f32(beam.azimuth_rad);
  writer.f32(beam.azimuth_sweep_rad);
  writer.f32(beam.elevation_rad);
  writer.f32(beam.elevation_sweep_rad);
  writer.f32(0);  // percentage of the sweep
  writer.u8(beam.function);
  writer.u8(static_cast<std::uint8_t>(beam.targets.size()));
  writer.u8(0);  // high density of tracks
  writer.u8(version >= 7 && beam.is_off ? 1 : 0);
  writer.u32(0);  // jamming technique
  for (const EntityId& target : beam.targets) {
    writeId(writer, target);
    writer.u16(0);
  }
}

}  // namespace

std::vector<std::uint8_t> encode(Header header, const EntityState& state) {
  BigEndianWriter writer;
  writeHeader(writer, header, PduType::entity_state, kEntityInformation);
  writeId(writer, state.id);
  writer.u8(state.force);
  writer.u8(0);  // articulation parameters
  writeType(writer, state.type);
  writer.zeros(8);  // alternative type
  writer.floats(state.velocity_mps);
  writer.doubles(state.position_m);
  writer.floats(state.orientation_rad);
  writer.u32(state.appearance);
  writer.u8(state.algorithm);
  writer.zeros(15);
  writer.floats(state.acceleration_mps2);
  writer.floats(state.turn_radps);
  writer.u8(1);  // ASCII
  for (std::size_t i = 0; i < kMarkingBytes; ++i)
    writer.u8(i < state.marking.size() ? static_cast<std::uint8_t>(state.marking[i]) : 0);
  writer.u32(0);  // capabilities
  return finished(writer);
}

std::vector<std::uint8_t> encode(Header header, const Emission& emission) {
  BigEndianWriter writer;
  writeHeader(writer, header, PduType::emission, kEmissionRegeneration);
  writeId(writer, emission.entity);
  writeId(writer, {emission.entity.site, emission.entity.application, emission.event});
  writer.u8(emission.is_change ? 1 : 0);
  writer.u8(static_cast<std::uint8_t>(emission.systems.size()));
  writer.u16(0);
  for (const EmissionSystem& system : emission.systems) {
    std::size_t size = 20;
    for (const EmissionBeam& beam : system.beams) size += 52 + 8 * beam.targets.size();
    writer.u8(words(size));
    writer.u8(static_cast<std::uint8_t>(system.beams.size()));
    writer.u16(0);
    writer.u16(system.name);
    writer.u8(system.function);
    writer.u8(system.number);
    writer.floats(system.location_m);
    for (const EmissionBeam& beam : system.beams) writeBeam(writer, beam, header.version);
  }
  return finished(writer);
}

std::vector<std::uint8_t> encode(Header header, const Transmitter& transmitter) {
  BigEndianWriter writer;
  writeHeader(writer, header, PduType::transmitter, kRadioCommunications);
  writeId(writer, transmitter.entity);
  writer.u16(transmitter.radio);
  writeType(writer, transmitter.type);
  writer.u8(transmitter.state);
  writer.u8(0);   // source of the input
  writer.u16(0);  // variable parameters (version 7), padding
  writer.doubles(transmitter.antenna_m);
  writer.floats(transmitter.relative_antenna_m);
  writer.u16(transmitter.antenna_pattern);
  writer.u16(0);  // length of the antenna pattern
  writer.u64(transmitter.frequency_hz);
  writer.f32(transmitter.bandwidth_hz);
  writer.f32(transmitter.power_dbm);
  for (const std::uint16_t modulation : transmitter.modulation) writer.u16(modulation);
  writer.zeros(8);
  return finished(writer);
}

}  // namespace emscape::interop::dis
