#include "propagation/itm/itm.h"

#include <fmt/core.h>

namespace emscape::propagation {
namespace {

const char* const kEnds[2] = {"transmitter", "receiver"};

std::string outside(const ModelLimit& limit, const char* whose = "") {
  return fmt::format("{}{}{}", whose, *whose ? ": " : "", outsideMessage(limit));
}

}  // namespace

std::string itmMessage(ItmStatus status) {
  switch (status) {
    case ItmStatus::done:
      return "done";
    case ItmStatus::done_with_warnings:
      return "done, with warnings";
    case ItmStatus::transmitter_height:
      return outside(kItmHeight, kEnds[0]);
    case ItmStatus::receiver_height:
      return outside(kItmHeight, kEnds[1]);
    case ItmStatus::climate:
      return "the climate is not one of 1..7";
    case ItmStatus::time:
      return outside(kItmPercentage, "time");
    case ItmStatus::location:
      return outside(kItmPercentage, "locations");
    case ItmStatus::situation:
      return outside(kItmPercentage, "situations");
    case ItmStatus::refractivity:
      return outside(kItmSeaLevelRefractivity);
    case ItmStatus::frequency:
      return outside(kItmFrequency);
    case ItmStatus::permittivity:
      return outside(kItmPermittivity);
    case ItmStatus::conductivity:
      return outside(kItmConductivity);
    case ItmStatus::ground_impedance:
      return "the ground's impedance is more reactive than resistive: permittivity or conductivity is "
             "impossible";
    case ItmStatus::variability_mode:
      return "the mode of variability is not one of 0..3, 10..13, 20..23";
    case ItmStatus::effective_earth:
      return outside(kItmEffectiveEarth);
    case ItmStatus::distance:
      return "the distance is not above 0";
    case ItmStatus::irregularity:
      return outside(kItmIrregularity);
    case ItmStatus::transmitter_siting:
      return "transmitter: the siting is not one of random, careful, very careful";
    case ItmStatus::receiver_siting:
      return "receiver: the siting is not one of random, careful, very careful";
    case ItmStatus::surface_refractivity_too_small:
    case ItmStatus::surface_refractivity_too_large:
      return outside(kItmSurfaceRefractivity);
    case ItmStatus::profile:
      return "the terrain profile has fewer than two intervals or lacks a height";
  }
  return "unknown status";
}

std::vector<std::string> itmMessages(unsigned warnings) {
  struct Meaning {
    ItmWarning bit;
    std::string message;
  };
  const Meaning meanings[] = {
      {kItmWarnTransmitterHeight, outside(kItmProvenHeight, kEnds[0])},
      {kItmWarnReceiverHeight, outside(kItmProvenHeight, kEnds[1])},
      {kItmWarnFrequency, outside(kItmProvenFrequency)},
      {kItmWarnDistanceOver1000km, outside(kItmProvenDistance)},
      {kItmWarnDistanceOver2000km, outside(kItmDistance)},
      {kItmWarnDistanceUnderHeights,
       "the path is shorter than five times the difference of the effective heights"},
      {kItmWarnDistanceUnder1km, outside(kItmDistance)},
      {kItmWarnTransmitterHorizonAngle, outside(kItmHorizonAngle, kEnds[0])},
      {kItmWarnReceiverHorizonAngle, outside(kItmHorizonAngle, kEnds[1])},
      {kItmWarnTransmitterHorizonNear, outside(kItmHorizonDistance, kEnds[0])},
      {kItmWarnReceiverHorizonNear, outside(kItmHorizonDistance, kEnds[1])},
      {kItmWarnTransmitterHorizonFar, outside(kItmHorizonDistance, kEnds[0])},
      {kItmWarnReceiverHorizonFar, outside(kItmHorizonDistance, kEnds[1])},
      {kItmWarnExtremeVariability, outside(kItmDeviate)},
      {kItmWarnSurfaceRefractivity, outside(kItmProvenSurfaceRefractivity)},
  };
  std::vector<std::string> messages;
  for (const Meaning& meaning : meanings) {
    if (warnings & meaning.bit) messages.push_back(meaning.message);
  }
  return messages;
}

}  // namespace emscape::propagation
