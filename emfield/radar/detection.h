/// Detection of a target by a radar: exact probabilities from signal-to-noise ratio, for Swerling's cases.
///
/// A square-law detector adds N pulses and compares with a threshold T (in units of the noise power of one
/// pulse). Given the signal energy X of all pulses (in the same unit), the sum exceeds T with probability
/// Q(N + K, T), K a Poisson number of mean X and Q the regularised upper gamma function. Over the target's
/// fluctuation K is Poisson (case 0) or negative binomial of shape 1, N, 2 or 2 N (cases 1 to 4), so that
///   Pd = sum over k of P(K = k) Q(N + k, T)
/// which has positive terms only. See Marcum 1947; Swerling 1954; Shnidman 1998 (IEEE Trans. AES-34) for this
/// form.
#pragma once

#include <vector>

#include "base/math/fast_math.h"
#include "emscape/base/host_device.h"
#include "emscape/scenario/model/emitter.h"

namespace emscape::emfield {

/// Fluctuation of a target's echo.
enum class Swerling {
  steady,            ///< case 0
  slow_exponential,  ///< case 1: Rayleigh, from scan to scan
  fast_exponential,  ///< case 2: Rayleigh, from pulse to pulse
  slow_dominant,     ///< case 3: one dominant scatterer, from scan to scan
  fast_dominant      ///< case 4: one dominant scatterer, from pulse to pulse
};

/// @param swerling_case  0..4
/// @throws Error (bad_input) otherwise
Swerling swerlingOfCase(int swerling_case);

/// The detector.
struct Detector {
  Swerling swerling = Swerling::slow_exponential;
  int pulses = 1;                         ///< N, summed; 1..kMaxPulses
  double false_alarm_probability = 1e-6;  ///< per decision; kMinFalseAlarm..0.5
};
inline bool operator==(const Detector& a, const Detector& b) {
  return a.swerling == b.swerling && a.pulses == b.pulses &&
         a.false_alarm_probability == b.false_alarm_probability;
}

constexpr int kMaxPulses = 1000000;
constexpr double kMinFalseAlarm = 1e-15;

/// Threshold T with Q(N, T) = Pfa: noise alone exceeds it with the probability of false alarm.
/// @throws Error (bad_input) for a detector outside the stated ranges
/// @accuracy 1e-12 relative, 1 to 1000 pulses
double detectionThreshold(const Detector& detector);

/// Probability of detection.
/// @param threshold  of the detector (detectionThreshold)
/// @param snr        mean signal-to-noise ratio of one pulse, as a ratio, >= 0; NaN gives NaN
/// @accuracy 1e-10 absolute, 1 to 1000 pulses, Pfa down to 1e-12
double detectionProbability(const Detector& detector, double threshold, double snr);

/// Signal-to-noise ratio (dB) of one pulse required for a probability of detection: the inverse of
/// detectionProbability, to 1e-9 dB.
/// @param probability  above the probability of false alarm, below 1
/// @throws Error (bad_input) otherwise
double requiredSnrDb(const Detector& detector, double probability);

/// Albersheim's approximation of requiredSnrDb for a steady target; the detector's Swerling case is ignored.
/// Within 0.2 dB for 1 to 8096 pulses, Pd 0.1 to 0.9, Pfa 1e-7 to 1e-3.
/// @see W. J. Albersheim, Proc. IEEE 69 (1981), p. 839
double albersheimSnrDb(const Detector& detector, double probability);

/// Shnidman's approximation of requiredSnrDb for all cases. Within 0.5 dB for 1 to 100 pulses, Pd 0.1 to
/// 0.99, Pfa 1e-9 to 1e-3.
/// @see D. A. Shnidman, IEEE Trans. AES-38 (2002), p. 1059
double shnidmanSnrDb(const Detector& detector, double probability);

/// Probability of detection of a steady target by the inverse of Albersheim's formula. Within 0.05 of the
/// exact probability for 0.1 to 0.9. Below 0.1 the formula does not hold (its minimum is 0.004 at
/// Pfa 1e-12, 0.07 at 1e-3): there it is the exact probability, with its signal-to-noise ratio shifted so
/// that both meet, and decreases to the probability of false alarm. For Pfa above 1e-3 both meet above 0.1.
double albersheimProbability(const Detector& detector, double snr_db);

/// The same by Shnidman's formula: the largest probability whose required ratio is at most the given one. It
/// is constant where the formula jumps, at Pd = 0.872.
double shnidmanProbability(const Detector& detector, double snr_db);

/// Signal-to-noise ratio (dB) of one pulse at which a method has a probability of detection: the inverse of
/// detectionProbability, albersheimProbability or shnidmanProbability.
/// @param probability  above the probability of false alarm, below 1; 0.1 to 0.87 for shnidman
/// @throws Error (bad_input) for a probability not above that of false alarm, or not below 1
double requiredSnrDb(const Detector& detector, scenario::DetectionMethod method, double probability);

/// Probability of detection over signal-to-noise in dB, for inner loops: monotone cubics between exact
/// values.
struct DetectionCurveView {
  struct Knot {
    float probability;
    float rise;  ///< slope times the step
  };
  const Knot* knots = nullptr;
  int count = 0;  ///< >= 2
  float first_snr_db = 0;
  float steps_per_db = 0;

  /// Increases with snr_db; without branches, for SIMD. The probability of false alarm below the first knot,
  /// constant above the last one; NaN for NaN.
  /// @accuracy 1e-4 absolute of detectionProbability; 2e-3 of the formulas
  EMSCAPE_HD float operator()(float snr_db) const {
    const float index = (snr_db - first_snr_db) * steps_per_db;
    const float not_below = index > 0 ? index : 0.0f;
    const int whole = int(not_below < float(count) ? not_below : float(count));
    const int i = whole < count - 2 ? whole : count - 2;
    const float beyond = not_below - float(i);
    const float t = beyond < 1 ? beyond : 1.0f;
    const Knot a = knots[i], b = knots[i + 1];
    const float rise = b.probability - a.probability;
    // Hermite cubic with slopes limited so that it never decreases.
    const float probability =
        a.probability +
        t * (a.rise + t * (3 * rise - 2 * a.rise - b.rise + t * (a.rise + b.rise - 2 * rise)));
    return index == index ? probability : index;
  }
};

/// Probability that the sum of the open pulses of a look exceeds the threshold, which is that of their number
/// over a mean noise, if each of the N pulses is open with the same probability, independently. The sum is a
/// gamma variable of the mean and the variance of the open pulses.
struct BlankedCurveView {
  static constexpr float kRowsPerOctave = 4;
  static constexpr int kVariances = 13,
                       kLeast_octaves = -6;  ///< of variance over square of the mean: 2^-6..2^6
  const float* probabilities = nullptr;      ///< of a row, those of the means of each variance
  int rows = 0;                              ///< >= 2, from open parts of 1 down
  int count = 0;                             ///< of means, >= 2
  float first_db = 0, steps_per_db = 0;
  float pulses = 1;  ///< N

  /// @param open      part of the pulses (0..1)
  /// @param mean_db   power of an open pulse over the noise which the threshold follows
  /// @param variance  of the power of an open pulse, over the square of its mean
  /// @accuracy 1e-2 absolute of the gamma variable's
  EMSCAPE_HD float operator()(float open, float mean_db, float variance) const {
    const float wanted = -kRowsPerOctave * fastLog2(open + 1e-30f);
    const float index = wanted > 0 ? wanted : 0.0f;
    const int row = int(index < float(rows - 2) ? index : float(rows - 2));
    const float of_row = fastExp2(-float(row) / kRowsPerOctave);
    const float of_next = of_row * 0.84089642f;  // 2^(-1/4)
    const float above = ofRow(row, mean_db, variance), below = ofRow(row + 1, mean_db, variance);
    const float part = (of_row - open) / (of_row - of_next);
    const float between = above + (part > 0 ? part : 0.0f) * (below - above);
    return open < of_next ? below * (open / of_next) : between;
  }
  /// With all pulses open.
  EMSCAPE_HD float unblanked(float mean_db, float variance) const { return ofRow(0, mean_db, variance); }

 private:
  EMSCAPE_HD float ofRow(int row, float mean_db, float variance) const {
    const float mean = within((mean_db - first_db) * steps_per_db, float(count - 1));
    const float layer =
        within(fastLog2(variance > 0 ? variance : 1e-30f) - float(kLeast_octaves), float(kVariances - 1));
    const int i = int(mean < float(count - 2) ? mean : float(count - 2));
    const int j = int(layer < float(kVariances - 2) ? layer : float(kVariances - 2));
    const int low = (row * kVariances + j) * count + i, high = low + count;
    const float t = mean - float(i), u = layer - float(j);
    const float of_low = probabilities[low] + t * (probabilities[low + 1] - probabilities[low]);
    const float of_high = probabilities[high] + t * (probabilities[high + 1] - probabilities[high]);
    return of_low + u * (of_high - of_low);
  }
  EMSCAPE_HD static float within(float index, float last) {
    const float not_below = index > 0 ? index : 0.0f;
    return not_below < last ? not_below : last;
  }
};

/// Holds the knots of a curve.
class DetectionCurve {
 public:
  /// @param loss_db  shift of the curve to larger signal-to-noise ratios
  /// @param blanks   with a curve of blanked pulses
  /// @throws Error (bad_input) for a detector outside the stated ranges
  explicit DetectionCurve(const Detector& detector,
                          scenario::DetectionMethod method = scenario::DetectionMethod::exact,
                          double loss_db = 0, bool blanks = false);

  bool isOf(const Detector& detector, scenario::DetectionMethod method, double loss_db, bool blanks) const {
    return detector == detector_ && method == method_ && loss_db == loss_db_ && blanks == !rows_.empty();
  }

  /// Without the loss.
  BlankedCurveView blanked() const {
    const int row = BlankedCurveView::kVariances * row_means_;
    return {rows_.data(),
            row > 0 ? int(rows_.size()) / row : 0,
            row_means_,
            float(kFirstMean_db),
            float(1 / kMeanStep_db),
            float(detector_.pulses)};
  }
  double loss_db() const { return loss_db_; }

  DetectionCurveView view() const {
    return {knots_.data(), int(knots_.size()), first_snr_db_, steps_per_db_};
  }

 private:
  Detector detector_;
  scenario::DetectionMethod method_;
  double loss_db_;
  std::vector<DetectionCurveView::Knot> knots_;
  float first_snr_db_ = 0, steps_per_db_ = 0;
  static constexpr double kFirstMean_db = -10, kMeanStep_db = 0.25;
  std::vector<float> rows_;  ///< of blanked()
  int row_means_ = 0;

  void addRows();
};

/// True if a target's echo is the same in all pulses of a look: also any that has one pulse.
inline bool isSteadyInALook(const Detector& detector) {
  return detector.pulses == 1 ||
         (detector.swerling != Swerling::fast_exponential && detector.swerling != Swerling::fast_dominant);
}

}  // namespace emscape::emfield
