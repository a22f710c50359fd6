#include "interop/importing/beam_pieces.h"

#include <algorithm>
#include <cmath>

namespace emscape::interop {
namespace {

/// Two unknown values are equal.
bool near(double a, double b, double tolerance) {
  if (std::isnan(a) || std::isnan(b)) return std::isnan(a) && std::isnan(b);
  return std::abs(a - b) <= tolerance;
}

bool equalSettings(const BeamState& a, const BeamState& b) {
  const auto nearPart = [](double x, double y, double part) { return near(x, y, part * std::abs(x)); };
  return nearPart(a.frequency_hz, b.frequency_hz, 1e-3) && nearPart(a.bandwidth_hz, b.bandwidth_hz, 1e-2) &&
         near(a.erp_dbm, b.erp_dbm, 0.25) && near(a.power_dbm, b.power_dbm, 0.25) &&
         nearPart(a.prf_hz, b.prf_hz, 1e-2) && nearPart(a.pulse_width_s, b.pulse_width_s, 1e-2) &&
         near(a.azimuth_half_sweep_deg, b.azimuth_half_sweep_deg, 0.5) &&
         near(a.elevation_half_sweep_deg, b.elevation_half_sweep_deg, 0.5) &&
         near(a.beamwidth_az_deg, b.beamwidth_az_deg, 0.5) &&
         near(a.beamwidth_el_deg, b.beamwidth_el_deg, 0.5);
}

/// Adds a span, joined with the last one if they touch.
void append(std::vector<TimeSpan>& spans, const TimeSpan& span) {
  if (span.end_s <= span.begin_s) return;
  if (!spans.empty() && span.begin_s <= spans.back().end_s) {
    spans.back().end_s = std::max(spans.back().end_s, span.end_s);
  } else {
    spans.push_back(span);
  }
}

double orZero(double value) {
  return std::isnan(value) ? 0 : value;
}

double apart(const Pointing& a, const Pointing& b) {
  return std::max(std::abs(std::remainder(a.azimuth_deg - b.azimuth_deg, 360)),
                  std::abs(a.elevation_deg - b.elevation_deg));
}

std::vector<Pointing> joined(const std::vector<Pointing>& pointings, double tolerance_deg) {
  std::vector<Pointing> result;
  for (const Pointing& pointing : pointings) {
    if (!result.empty() && apart(result.back(), pointing) <= tolerance_deg) {
      result.back().end_s = pointing.end_s;
    } else {
      result.push_back(pointing);
    }
  }
  return result;
}

}  // namespace

std::vector<TimeSpan> presenceOf(const RecordedObject& object, TimeSpan window) {
  std::vector<TimeSpan> spans;
  double begin_s = std::max(window.begin_s, object.poses.front().t_s);
  // A first state that is told a moment after the window's begin holds at the begin, too.
  if (object.poses.front().t_s <= window.begin_s + 1) begin_s = window.begin_s;
  bool is_present = true;
  for (const PresenceSample& sample : object.presence) {
    if (sample.is_present == is_present) continue;
    if (is_present) append(spans, {begin_s, std::min(sample.t_s, window.end_s)});
    is_present = sample.is_present;
    begin_s = std::max(window.begin_s, sample.t_s);
  }
  if (is_present) append(spans, {begin_s, window.end_s});
  return spans;
}

std::vector<BeamPiece> piecesOf(const RecordedBeam& beam, const std::vector<TimeSpan>& presence, bool& cut) {
  std::vector<BeamPiece> pieces;
  for (std::size_t i = 0; i < beam.states.size(); ++i) {
    const BeamState& state = beam.states[i];
    if (!state.is_on) continue;
    const double end_s =
        i + 1 < beam.states.size() ? beam.states[i + 1].t_s : std::numeric_limits<double>::infinity();
    std::vector<TimeSpan> spans;
    for (const TimeSpan& span : presence)
      append(spans, {std::max(span.begin_s, state.t_s), std::min(span.end_s, end_s)});
    if (spans.empty()) continue;
    auto piece = std::find_if(pieces.begin(), pieces.end(),
                              [&](const BeamPiece& p) { return equalSettings(p.state, state); });
    if (piece == pieces.end()) {
      if (pieces.size() >= kMaxPieces) {
        cut = true;
        continue;
      }
      pieces.push_back({state, {}, {}});
      piece = pieces.end() - 1;
    }
    const bool points = !std::isnan(state.azimuth_deg) || !std::isnan(state.elevation_deg);
    for (const TimeSpan& span : spans) {
      append(piece->active, span);
      if (!points) continue;
      const Pointing next{span.begin_s, span.end_s, orZero(state.azimuth_deg), orZero(state.elevation_deg)};
      if (!piece->pointings.empty() && apart(piece->pointings.back(), next) == 0) {
        piece->pointings.back().end_s = next.end_s;
      } else {
        piece->pointings.push_back(next);
      }
    }
  }
  return pieces;
}

std::vector<Pointing> reduced(const std::vector<Pointing>& pointings, std::size_t count) {
  for (double tolerance_deg = 0.1;; tolerance_deg *= 2) {
    std::vector<Pointing> result = joined(pointings, tolerance_deg);
    if (result.size() <= count || tolerance_deg > 360) return result;
  }
}

}  // namespace emscape::interop
