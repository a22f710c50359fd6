// Decoding and encoding of PDUs.
#include "recording/dis/pdu.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <random>

#include "tests/support/files.h"
#include "tests/support/reference_data.h"

namespace emscape::interop::dis {
namespace {

using testing::HasSubstr;
using Bytes = std::vector<std::uint8_t>;

EntityState someState() {
  EntityState state;
  state.id = {1, 2, 3};
  state.force = 2;
  state.type = {1, 2, 225, 1, 9, 3, 4};
  state.velocity_mps = {100, -20, 3};
  state.position_m = {4e6, 3e6, 4e6};
  state.orientation_rad = {0.5, -0.25, 3};
  state.appearance = 0x18;
  state.algorithm = 8;
  state.acceleration_mps2 = {1, 2, 3};
  state.turn_radps = {0.125, 0, -0.5};
  state.marking = "VIPER 1";
  return state;
}

Emission someEmission() {
  Emission emission;
  emission.entity = {1, 2, 3};
  emission.event = 7;
  for (int s = 0; s < 2; ++s) {
    EmissionSystem system;
    system.name = static_cast<std::uint16_t>(4000 + s);
    system.function = 3;
    system.number = static_cast<std::uint8_t>(s + 1);
    system.location_m = {1, 2, -3};
    for (int b = 0; b <= s; ++b) {
      EmissionBeam beam;
      beam.number = static_cast<std::uint8_t>(b + 1);
      beam.parameter_index = 12;
      beam.frequency_hz = 3e9;
      beam.erp_dbm = 95;
      beam.prf_hz = 1000;
      beam.pulse_width_us = 2;
      beam.azimuth_rad = 0.5;
      beam.azimuth_sweep_rad = 0.25;
      beam.function = 4;
      beam.targets.resize(static_cast<std::size_t>(3 * b), {9, 8, 7});
      system.beams.push_back(beam);
    }
    emission.systems.push_back(system);
  }
  return emission;
}

TEST(Pdu, EntityStateIsTheSameAfterEncoding) {
  const EntityState before = someState();
  const Bytes bytes = encode(Header{}, before);
  EXPECT_EQ(bytes.size(), 144u);
  const auto header = decodeHeader(bytes.data(), bytes.size());
  ASSERT_TRUE(header);
  EXPECT_EQ(header->length, 144);
  EXPECT_EQ(header->type, 1);
  std::string fault;
  const auto after = decodeEntityState(bytes.data(), bytes.size(), fault);
  ASSERT_TRUE(after) << fault;
  EXPECT_EQ(after->id.key(), before.id.key());
  EXPECT_EQ(after->type, before.type);
  EXPECT_EQ(after->position_m, before.position_m);
  EXPECT_EQ(after->velocity_mps, before.velocity_mps);
  EXPECT_EQ(after->orientation_rad, before.orientation_rad);
  EXPECT_EQ(after->turn_radps, before.turn_radps);
  EXPECT_EQ(after->acceleration_mps2, before.acceleration_mps2);
  EXPECT_EQ(after->algorithm, before.algorithm);
  EXPECT_EQ(after->marking, before.marking);
  EXPECT_TRUE(after->isDestroyed());
}

TEST(Pdu, EmissionOfSeveralSystemsAndBeamsIsTheSameAfterEncoding) {
  const Bytes bytes = encode(Header{}, someEmission());
  std::string fault;
  const auto after = decodeEmission(bytes.data(), bytes.size(), fault);
  ASSERT_TRUE(after) << fault;
  ASSERT_EQ(after->systems.size(), 2u);
  EXPECT_EQ(after->systems[1].name, 4001);
  EXPECT_EQ(after->systems[1].location_m, (Vec3d{1, 2, -3}));
  ASSERT_EQ(after->systems[1].beams.size(), 2u);
  const EmissionBeam& beam = after->systems[1].beams[1];
  EXPECT_EQ(beam.number, 2);
  EXPECT_EQ(beam.parameter_index, 12);
  EXPECT_EQ(beam.frequency_hz, 3e9);
  EXPECT_EQ(beam.erp_dbm, 95);
  EXPECT_EQ(beam.azimuth_sweep_rad, 0.25);
  ASSERT_EQ(beam.targets.size(), 3u);
  EXPECT_EQ(beam.targets[2].entity, 7);
}

TEST(Pdu, StatusBitTurnsABeamOffInVersion7Only) {
  Emission emission = someEmission();
  emission.systems[0].beams[0].is_off = true;
  Bytes bytes = encode(Header{}, emission);
  std::string fault;
  EXPECT_TRUE(decodeEmission(bytes.data(), bytes.size(), fault)->systems[0].beams[0].is_off);
  bytes[0] = 6;
  EXPECT_FALSE(decodeEmission(bytes.data(), bytes.size(), fault)->systems[0].beams[0].is_off);
}

TEST(Pdu, TransmitterIsTheSameAfterEncoding) {
  Transmitter before;
  before.entity = {1, 2, 3};
  before.radio = 4;
  before.state = 2;
  before.relative_antenna_m = {0, 0, -6};
  before.frequency_hz = 243000000;
  before.bandwidth_hz = 25000;
  before.power_dbm = 40;
  const Bytes bytes = encode(Header{}, before);
  EXPECT_EQ(bytes.size(), 104u);
  std::string fault;
  const auto after = decodeTransmitter(bytes.data(), bytes.size(), fault);
  ASSERT_TRUE(after) << fault;
  EXPECT_EQ(after->radio, 4);
  EXPECT_EQ(after->state, 2);
  EXPECT_EQ(after->relative_antenna_m.z, -6);
  EXPECT_EQ(after->frequency_hz, 243000000u);
  EXPECT_EQ(after->bandwidth_hz, 25000);
  EXPECT_EQ(after->power_dbm, 40);
}

TEST(Pdu, LengthsAndCountsThatLieAreFaults) {
  Bytes bytes = encode(Header{}, someEmission());
  std::string fault;
  Bytes more_systems = bytes;
  more_systems[25] = 200;
  EXPECT_FALSE(decodeEmission(more_systems.data(), more_systems.size(), fault));
  EXPECT_THAT(fault, HasSubstr("counts more systems, beams or targets than they"));
  Bytes more_beams = bytes;
  more_beams[29] = 255;
  EXPECT_FALSE(decodeEmission(more_beams.data(), more_beams.size(), fault));
  Bytes wrong_lengths = bytes;  // the lengths of system and beam are not needed
  wrong_lengths[28] = 3;
  wrong_lengths[48] = 208;
  EXPECT_TRUE(decodeEmission(wrong_lengths.data(), wrong_lengths.size(), fault));
  for (std::size_t size = 0; size < bytes.size(); ++size)
    EXPECT_FALSE(decodeEmission(bytes.data(), size, fault) && size < bytes.size()) << size;
}

TEST(Pdu, HeaderIsRefusedWithAnotherVersionOrMoreBytesThanThereAre) {
  Bytes bytes = encode(Header{}, someState());
  EXPECT_FALSE(decodeHeader(bytes.data(), 100));
  EXPECT_FALSE(decodeHeader(bytes.data(), 11));
  bytes[0] = 8;
  EXPECT_FALSE(decodeHeader(bytes.data(), bytes.size()));
  bytes[0] = 7;
  bytes[8] = bytes[9] = 0;
  EXPECT_FALSE(decodeHeader(bytes.data(), bytes.size()));
}

TEST(Pdu, StateWithoutAPositionNearTheEarthIsAFault) {
  EntityState state = someState();
  state.position_m = {};
  const Bytes bytes = encode(Header{}, state);
  std::string fault;
  EXPECT_FALSE(decodeEntityState(bytes.data(), bytes.size(), fault));
  EXPECT_THAT(fault, HasSubstr("not near the earth"));
}

TEST(Pdu, RandomBytesAreDecodedOrRefused) {
  std::mt19937 random(5);
  for (int i = 0; i < 20000; ++i) {
    Bytes bytes(12 + random() % 300);
    for (std::uint8_t& byte : bytes) byte = static_cast<std::uint8_t>(random());
    bytes[0] = static_cast<std::uint8_t>(5 + random() % 3);
    std::string fault;
    decodeEntityState(bytes.data(), bytes.size(), fault);
    decodeEmission(bytes.data(), bytes.size(), fault);
    decodeTransmitter(bytes.data(), bytes.size(), fault);
  }
}

/// A PDU of the sample data of open-dis-python; the expected values are those of that project's tests.
Bytes sample(const std::string& name) {
  const auto file = test::referenceFile("interop/dis/" + name);
  if (!file) return {};
  const std::string text = test::readFile(*file);
  return {text.begin(), text.end()};
}

TEST(Pdu, PublicEmissionSampleHasItsValues) {
  const Bytes bytes = sample("ElectromagneticEmissionPdu-single-system.raw");
  if (bytes.empty()) GTEST_SKIP() << test::notInRepository("interop/dis");
  std::string fault;
  const auto emission = decodeEmission(bytes.data(), bytes.size(), fault);
  ASSERT_TRUE(emission) << fault;
  EXPECT_EQ(emission->entity.site, 23);
  EXPECT_EQ(emission->entity.entity, 2);
  ASSERT_EQ(emission->systems.size(), 1u);
  const EmissionSystem& system = emission->systems[0];
  EXPECT_EQ(system.name, 28665);
  EXPECT_EQ(system.function, 2);
  ASSERT_EQ(system.beams.size(), 1u);
  const EmissionBeam& beam = system.beams[0];
  EXPECT_EQ(beam.frequency_hz, 9e9F);
  EXPECT_EQ(beam.erp_dbm, 70000);
  EXPECT_NEAR(beam.azimuth_sweep_rad, 3.14159, 1e-5);
  EXPECT_EQ(beam.function, 4);
  EXPECT_EQ(beam.targets.size(), 1u);
}

TEST(Pdu, PublicTransmitterSampleHasItsValues) {
  const Bytes bytes = sample("TransmitterPdu.raw");
  if (bytes.empty()) GTEST_SKIP() << test::notInRepository("interop/dis");
  std::string fault;
  const auto transmitter = decodeTransmitter(bytes.data(), bytes.size(), fault);
  ASSERT_TRUE(transmitter) << fault;
  EXPECT_EQ(transmitter->entity.site, 1677);
  EXPECT_EQ(transmitter->entity.application, 1678);
  EXPECT_EQ(transmitter->entity.entity, 169);
  EXPECT_EQ(transmitter->state, 2);
  EXPECT_EQ(transmitter->frequency_hz, 10000000000u);
  EXPECT_EQ(transmitter->bandwidth_hz, 20000);
  EXPECT_EQ(transmitter->power_dbm, 35);
}

}  // namespace
}  // namespace emscape::interop::dis
