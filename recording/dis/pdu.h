/// Protocol data units of DIS (IEEE 1278.1), versions 4 to 7, as plain values.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "emscape/base/vec.h"

namespace emscape::interop::dis {

constexpr std::size_t kHeaderBytes = 12;
constexpr std::size_t kMaxPduBytes = 8192;  ///< of the standard
constexpr std::size_t kMarkingBytes = 11;   ///< of an entity's name
/// Units of timestamps in an hour.
constexpr double kTimestampsPerHour = 2147483648.0;

enum class PduType : std::uint8_t {
  entity_state = 1,
  emission = 23,
  designator = 24,
  transmitter = 25,
  signal = 26,
  receiver = 27,
  iff = 28,
};
/// "Entity State", "type 67".
std::string nameOf(std::uint8_t type);

struct Header {
  std::uint8_t version = 7;
  std::uint8_t exercise = 1;
  std::uint8_t type = 0;
  std::uint32_t timestamp = 0;  ///< bit 0: absolute (since the hour, UTC)
  std::uint16_t length = 0;

  /// Seconds past the hour.
  double seconds() const { return (timestamp >> 1) * (3600.0 / kTimestampsPerHour); }
};

struct EntityId {
  std::uint16_t site = 0, application = 0, entity = 0;
  std::uint64_t key() const {
    return (std::uint64_t{site} << 32) | (std::uint64_t{application} << 16) | entity;
  }
};

struct EntityState {
  EntityId id;
  std::uint8_t force = 0;     ///< 1 friendly, 2 opposing, 3 neutral
  std::array<int, 7> type{};  ///< kind, domain, country, category, subcategory, specific, extra
  Vec3d velocity_mps;         ///< ECEF; body axes for the algorithms 6 to 9
  Vec3d position_m;           ///< ECEF
  Vec3d orientation_rad;      ///< psi, theta, phi from ECEF axes to body axes
  std::uint32_t appearance = 0;
  std::uint8_t algorithm = 2;  ///< of dead reckoning
  Vec3d acceleration_mps2;
  Vec3d turn_radps;  ///< angular velocity, body axes
  std::string marking;

  /// Appearance of platforms: damage (bits 3 and 4) is "destroyed".
  bool isDestroyed() const { return type[0] == 1 && ((appearance >> 3) & 3) == 3; }
};

/// Angles from the body's x axis, azimuth clockwise, elevation upwards; sweeps are half angles.
struct EmissionBeam {
  std::uint8_t number = 0;
  std::uint16_t parameter_index = 0;
  double frequency_hz = 0, frequency_range_hz = 0;
  double erp_dbm = 0;
  double prf_hz = 0;
  double pulse_width_us = 0;
  double azimuth_rad = 0, azimuth_sweep_rad = 0, elevation_rad = 0, elevation_sweep_rad = 0;
  std::uint8_t function = 0;
  bool is_off = false;  ///< by the status bit of version 7
  std::vector<EntityId> targets;
};

struct EmissionSystem {
  std::uint16_t name = 0;
  std::uint8_t function = 0;
  std::uint8_t number = 0;
  Vec3d location_m;  ///< in the body
  std::vector<EmissionBeam> beams;
};

struct Emission {
  EntityId entity;
  std::uint16_t event = 0;
  bool is_change = true;  ///< else all data of the entity's systems
  std::vector<EmissionSystem> systems;
};

struct Transmitter {
  EntityId entity;
  std::uint16_t radio = 0;
  std::array<int, 7> type{};
  std::uint8_t state = 0;             ///< 0 off, 1 on, 2 transmitting
  Vec3d antenna_m;                    ///< ECEF; zeros: the entity's
  Vec3d relative_antenna_m;           ///< in the body
  std::uint16_t antenna_pattern = 0;  ///< 0 omnidirectional, 1 beam
  std::uint64_t frequency_hz = 0;
  double bandwidth_hz = 0;
  double power_dbm = 0;
  std::array<std::uint16_t, 4> modulation{};
};

/// The header of a PDU; none if the bytes do not begin with one: versions 1 to 7, a length within 12 and what
/// there is.
std::optional<Header> decodeHeader(const std::uint8_t* bytes, std::size_t size);

/// The body of a PDU. Counts and lengths in it are never trusted: what does not fit into the PDU is a fault.
/// @param bytes  from the header on  @param size  of the PDU
/// @param fault  receives the reason if the result is none
std::optional<EntityState> decodeEntityState(const std::uint8_t* bytes, std::size_t size, std::string& fault);
std::optional<Emission> decodeEmission(const std::uint8_t* bytes, std::size_t size, std::string& fault);
std::optional<Transmitter> decodeTransmitter(const std::uint8_t* bytes, std::size_t size, std::string& fault);

/// The bytes of a PDU; type and length of the header are set.
/// @throws std::length_error for more than 8192 bytes
std::vector<std::uint8_t> encode(Header header, const EntityState& state);
std::vector<std::uint8_t> encode(Header header, const Emission& emission);
std::vector<std::uint8_t> encode(Header header, const Transmitter& transmitter);

}  // namespace emscape::interop::dis
