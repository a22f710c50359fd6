/// Values that several sections of the scenario format share, with their units and limits.
#pragma once

#include <utility>

#include "base/geodesy/position_limits.h"
#include "document/schema.h"
#include "scenario/file/schema.h"

namespace emscape::scenario {

/// One of the names of an enumeration.
template <class Enum>
ValueSpec choiceOf() {
  const auto names = namesOf(Enum());
  return document::spec::choice({names.begin(), names.end()});
}

inline const ValueSpec kInteger = document::spec::simple(document::ValueType::integer);
inline const ValueSpec kName = document::spec::textOf(document::ValueType::text, 200).printable();
inline const ValueSpec kFile = document::spec::textOf(document::ValueType::file, 4096);
inline const ValueSpec kLatitude =
    document::spec::number("deg").from(-PositionLimits::kLatitude_deg).to(PositionLimits::kLatitude_deg);
inline const ValueSpec kLongitude =
    document::spec::number("deg").from(-PositionLimits::kLongitude_deg).to(PositionLimits::kLongitude_deg);
inline const ValueSpec kHeight =
    document::spec::number("m").from(PositionLimits::kLowest_m).to(PositionLimits::kHighest_m);
inline const ValueSpec kHeightAboveGround = document::spec::number("m").from(0).to(100000);
inline const ValueSpec kAngle = document::spec::number("deg").from(-360).to(360);
inline const ValueSpec kElevation = document::spec::number("deg").from(-90).to(90);
inline const ValueSpec kTime = document::spec::number("s").from(0).to(1e8);
inline const ValueSpec kFrequency = document::spec::number("Hz").from(1e6).to(1e12);
inline const ValueSpec kBandwidth = document::spec::number("Hz").above(0).to(1e11);
inline const ValueSpec kLoss = document::spec::number("dB").from(0).to(100);
inline const ValueSpec kGain = document::spec::number("dBi").from(-50).to(80);
inline const ValueSpec kNoiseFigure = document::spec::number("dB").from(0).to(60);
inline const ValueSpec kNoiseTemperature = document::spec::number("K").from(0).to(10000);
inline const ValueSpec kRcs = document::spec::number("m2").above(0).to(1e9);
inline const ValueSpec kSwerling = kInteger.from(0).to(4);
inline constexpr int kMaxItems = 10000;

}  // namespace emscape::scenario
