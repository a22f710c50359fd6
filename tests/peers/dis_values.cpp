// Prints what the PDUs of a capture decode to, one JSON list a PDU, for comparison with other decoders.
//   dis_values CAPTURE.pcap
#include <iostream>
#include <nlohmann/json.hpp>

#include "recording/common/byte_source.h"
#include "recording/common/recording.h"
#include "recording/dis/datagrams.h"
#include "recording/dis/pdu.h"

namespace {

using namespace emscape;
using namespace emscape::interop::dis;
using Json = nlohmann::json;

Json of(const EntityId& id) {
  return {id.site, id.application, id.entity};
}
Json of(const Vec3d& v) {
  return {v.x, v.y, v.z};
}

Json of(const EntityState& s) {
  return {1,
          of(s.id),
          s.force,
          s.type,
          of(s.velocity_mps),
          of(s.position_m),
          of(s.orientation_rad),
          s.appearance,
          s.algorithm,
          of(s.acceleration_mps2),
          of(s.turn_radps),
          s.marking};
}

Json of(const Emission& e) {
  Json systems = Json::array();
  for (const EmissionSystem& system : e.systems) {
    Json beams = Json::array();
    for (const EmissionBeam& b : system.beams) {
      Json targets = Json::array();
      for (const EntityId& target : b.targets) targets.push_back(of(target));
      beams.push_back({b.number,
                       b.parameter_index,
                       {b.frequency_hz, b.frequency_range_hz, b.erp_dbm, b.prf_hz, b.pulse_width_us,
                        b.azimuth_rad, b.azimuth_sweep_rad, b.elevation_rad, b.elevation_sweep_rad},
                       b.function,
                       targets});
    }
    systems.push_back({system.name, system.function, system.number, of(system.location_m), beams});
  }
  return {23, of(e.entity), e.event, e.is_change, systems};
}

Json of(const Transmitter& t) {
  return {25,
          of(t.entity),
          t.radio,
          t.type,
          t.state,
          of(t.antenna_m),
          of(t.relative_antenna_m),
          t.antenna_pattern,
          t.frequency_hz,
          t.bandwidth_hz,
          t.power_dbm,
          t.modulation};
}

template <class Pdu>
void print(const std::optional<Pdu>& pdu, const std::string& fault) {
  std::cout << (pdu ? of(*pdu) : Json(fault)).dump() << "\n";
}

}  // namespace

int main(int argc, char** argv) {
  if (argc != 2) return 2;
  const auto source = interop::openFile(argv[1]);
  interop::ReadingTally tally;
  readCapture(*source, tally, [](const Datagram& datagram) {
    const auto header = decodeHeader(datagram.bytes, datagram.size);
    std::string fault = "no header";
    if (!header) return print(std::optional<EntityState>(), fault);
    const auto type = static_cast<PduType>(header->type);
    if (type == PduType::entity_state) print(decodeEntityState(datagram.bytes, header->length, fault), fault);
    if (type == PduType::emission) print(decodeEmission(datagram.bytes, header->length, fault), fault);
    if (type == PduType::transmitter) print(decodeTransmitter(datagram.bytes, header->length, fault), fault);
  });
}
