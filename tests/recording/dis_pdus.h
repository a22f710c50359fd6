/// PDUs for tests of what takes them.
#pragma once

#include <cmath>
#include <cstdint>
#include <vector>

#include "recording/dis/pdu.h"

namespace emscape::test {

/// The bytes of a PDU of a sender whose clock tells a time.
template <class Pdu>
std::vector<std::uint8_t> pduAt(int version, double sent_s, const Pdu& pdu) {
  constexpr double kHour_s = 3600;
  interop::dis::Header header;
  header.version = static_cast<std::uint8_t>(version);
  header.timestamp =
      static_cast<std::uint32_t>(std::fmod(sent_s, kHour_s) / kHour_s * interop::dis::kTimestampsPerHour)
      << 1;
  return interop::dis::encode(header, pdu);
}

/// An emission of one radar, of emitter name 28665, with beams of some numbers.
inline interop::dis::Emission radarOf(const interop::dis::EntityId& entity, const std::vector<int>& beams) {
  interop::dis::Emission emission;
  emission.entity = entity;
  interop::dis::EmissionSystem system;
  system.name = 28665;
  system.function = 3;
  system.number = 1;
  for (const int number : beams) {
    interop::dis::EmissionBeam beam;
    beam.number = static_cast<std::uint8_t>(number);
    beam.frequency_hz = 3e9;
    beam.erp_dbm = 90;
    beam.function = 1;
    system.beams.push_back(beam);
  }
  emission.systems.push_back(system);
  return emission;
}

}  // namespace emscape::test
