/// Writers of recordings, one per format.
#pragma once

#include <cstdint>
#include <functional>
#include <ostream>
#include <string>
#include <vector>

#include "interop/export_scenario.h"
#include "interop/exporting/motion.h"

namespace emscape::interop {

/// What the writers need.
struct ExportJob {
  const scenario::Scenario& scenario;
  const scenario::Terrain* terrain;
  double step_s;
  ProgressSink progress;
  std::string czml_packets = {};  ///< further ones, each after ",\n"
};

/// Receives the text of a file in pieces.
using TextSink = std::function<void(const std::string& piece)>;

/// Receives PDUs in the order of their times (s of the scenario).
using PduSink = std::function<void(double t_s, const std::vector<std::uint8_t>& bytes)>;

/// @param rows  receives the rows of the emitter database
/// @return number of records
long long writeAcmi(const ExportJob& job, const TextSink& sink, std::vector<ExportedRow>& rows);
long long writeDis(const ExportJob& job, const PduSink& sink, std::vector<ExportedRow>& rows);
long long writeAsi(const ExportJob& job, const TextSink& sink, std::vector<ExportedRow>& rows);
long long writeCot(const ExportJob& job, const TextSink& sink, std::vector<ExportedRow>& rows);
long long writeCzml(const ExportJob& job, const TextSink& sink, std::vector<ExportedRow>& rows);
long long writeKml(const ExportJob& job, const TextSink& sink, std::vector<ExportedRow>& rows);
long long writeCapture(const ExportJob& job, std::ostream& stream, std::vector<ExportedRow>& rows);

/// Rows of a format that tells objects but no beams: one for the first emitter of each platform.
void addRowsOfPlatforms(const scenario::Scenario& scenario, std::vector<ExportedRow>& rows);

/// Number of platforms whose names are longer than a marking of DIS, or not in ASCII.
int countChangedMarkings(const scenario::Scenario& scenario);

}  // namespace emscape::interop
