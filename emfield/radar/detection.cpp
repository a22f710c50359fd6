#include "emfield/radar/detection.h"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>

#include "emscape/base/error.h"
#include "emscape/base/units.h"

namespace emscape::emfield {
namespace {

void check(const Detector& detector) {
  if (detector.pulses < 1 || detector.pulses > kMaxPulses) {
    throw Error(ErrorCode::bad_input,
                fmt::format("pulses: {} is outside 1..{}", detector.pulses, kMaxPulses));
  }
  const double pfa = detector.false_alarm_probability;
  if (!(pfa >= kMinFalseAlarm && pfa <= 0.5)) {
    throw Error(ErrorCode::bad_input, fmt::format("probability of false alarm: {:.6g} is outside {:.6g}..0.5",
                                                  pfa, kMinFalseAlarm));
  }
}

void checkProbability(const Detector& detector, double probability) {
  if (!(probability > detector.false_alarm_probability && probability < 1)) {
    throw Error(ErrorCode::bad_input,
                fmt::format("probability of detection: {:.6g} is outside {:.6g}..1, from the probability of "
                            "false alarm to certainty",
                            probability, detector.false_alarm_probability));
  }
}

/// log(n!), n >= 0, by Stirling's series; std::lgamma is not used because it writes a global variable.
double logFactorial(double n) {
  double shift = 0;
  for (; n < 16; ++n) shift += std::log(n + 1);
  const double inverse = 1 / n, square = inverse * inverse;
  return n * std::log(n) - n + 0.5 * std::log(2 * kPi * n) +
         inverse * (1.0 / 12 - square * (1.0 / 360 - square * (1.0 / 1260 - square / 1680))) - shift;
}

/// Poisson probability of n events with mean `mean` > 0.
double poisson(double mean, double n) {
  return std::exp(n * std::log(mean) - mean - logFactorial(n));
}

/// Q(n, t), the regularised upper gamma function of a whole n >= 1: the Poisson probability of fewer than n
/// events with mean t > 0.
double upperGamma(int n, double t) {
  // The terms decrease on both sides of the largest, which is at n - 1 or, for small t, at t.
  const int top = std::min(n - 1, int(t));
  const double largest = poisson(t, top);
  double sum = 0;
  double term = largest;
  for (int j = top; j >= 0 && term > 1e-18 * sum; --j) {
    sum += term;
    term *= j / t;
  }
  term = largest;
  for (int j = top + 1; j < n && term > 1e-18 * sum; ++j) {
    term *= t / j;
    sum += term;
  }
  return sum;
}

/// Q(a, x) of any shape a > 0, x >= 0: the probability that a gamma variable of that shape exceeds x. By the
/// series or the continued fraction within 1e-9, above a shape of 500 by Wilson and Hilferty's cube root
/// within 1e-4.
double gammaAbove(double a, double x) {
  if (a > 500) {
    const double deviation = 1 / (9 * a);
    return std::erfc((std::cbrt(x / a) - 1 + deviation) / std::sqrt(2 * deviation)) / 2;
  }
  if (x <= 0) return 1;
  const double density = std::exp(a * std::log(x) - x - logFactorial(a));  // x^a exp(-x) / Gamma(a + 1)
  constexpr double kPrecision = 1e-10;
  if (x < a + 1) {
    double term = 1, sum = 1;
    for (double n = a + 1; term > kPrecision * sum; ++n) sum += term *= x / n;
    return std::max(0.0, 1 - density * sum);
  }
  // Lentz's evaluation.
  double b = x + 1 - a, c = 1e300, d = 1 / b, fraction = d;
  for (int n = 1; n < 1000; ++n) {
    const double step = n * (a - n);
    b += 2;
    d = 1 / (step * d + b);
    c = b + step / c;
    fraction *= c * d;
    if (std::fabs(c * d - 1) < kPrecision) break;
  }
  return density * a * fraction;
}

/// Shape of the negative binomial distribution of K; 0 for the Poisson distribution.
double shapeOf(const Detector& detector) {
  switch (detector.swerling) {
    case Swerling::steady:
      return 0;
    case Swerling::slow_exponential:
      return 1;
    case Swerling::fast_exponential:
      return detector.pulses;
    case Swerling::slow_dominant:
      return 2;
    case Swerling::fast_dominant:
      return 2.0 * detector.pulses;
  }
  return 0;
}

/// P(K = 0), P(K = 1), ...: values that may start below the range of a double are stored as mantissa and
/// exponent.
class SignalCounts {
 public:
  SignalCounts(double shape, double mean) : shape_(shape), mean_(mean), missing_(mean / (shape + mean)) {
    exponent_ = shape == 0 ? -mean : shape * std::log1p(-missing_);
    scale_ = std::exp(exponent_);
  }

  double probability() const { return mantissa_ * scale_; }

  void next() {
    ++k_;
    mantissa_ *= shape_ == 0 ? mean_ / k_ : missing_ * (shape_ + k_ - 1) / k_;
    if (mantissa_ > kLarge) {
      mantissa_ /= kLarge;
      exponent_ += kLogLarge;
      scale_ = std::exp(exponent_);
    }
  }

 private:
  static constexpr double kLarge = 1e100;
  static constexpr double kLogLarge = 230.25850929940457;
  double shape_, mean_, missing_;
  double k_ = 0;
  double mantissa_ = 1, exponent_, scale_;
};

/// Monotone slopes of a cubic through equidistant values.
/// @see F. N. Fritsch, J. Butland, SIAM J. Sci. Stat. Comput. 5 (1984), p. 300
double monotoneRise(double before, double after) {
  return before * after <= 0 ? 0 : 2 * before * after / (before + after);
}

}  // namespace

Swerling swerlingOfCase(int swerling_case) {
  if (swerling_case < 0 || swerling_case > 4) {
    throw Error(ErrorCode::bad_input, fmt::format("Swerling case: {} is outside 0..4", swerling_case));
  }
  return static_cast<Swerling>(swerling_case);
}

double detectionThreshold(const Detector& detector) {
  check(detector);
  const int n = detector.pulses;
  const double wanted = std::log(detector.false_alarm_probability);
  // log Q is decreasing and concave in T: from below, a Newton step ends above the root; from above, the
  // steps decrease without passing it.
  double threshold = n + std::sqrt(-2.0 * n * wanted) - wanted;
  for (int i = 0; i < 100; ++i) {
    const double q = upperGamma(n, threshold);
    const double step = (std::log(q) - wanted) * q / poisson(threshold, n - 1);
    threshold = std::max(threshold + step, threshold / 2);
    if (std::fabs(step) < 1e-14 * threshold) break;
  }
  return threshold;
}

double detectionProbability(const Detector& detector, double threshold, double snr) {
  if (std::isnan(snr)) return snr;
  double over = upperGamma(detector.pulses, threshold);  // Q(N + k, T)
  if (snr <= 0) return over;
  double event = poisson(threshold, detector.pulses);  // Q(N + k + 1, T) - Q(N + k, T)
  SignalCounts counts(shapeOf(detector), detector.pulses * snr);
  double detected = 0, seen = 0;
  // Once Q is 1 to machine precision, all remaining terms are detections.
  for (int n = detector.pulses; n <= threshold || event > 1e-17; ++n) {
    const double p = counts.probability();
    detected += p * over;
    seen += p;
    if (1 - seen < 1e-17) break;
    over += event;
    event *= threshold / (n + 1);
    counts.next();
  }
  return std::min(1.0, detected + std::max(0.0, 1 - seen));
}

double requiredSnrDb(const Detector& detector, double probability) {
  const double threshold = detectionThreshold(detector);
  checkProbability(detector, probability);
  const auto tooWeak = [&](double snr_db) {
    return detectionProbability(detector, threshold, dbToRatio(snr_db)) < probability;
  };
  double low = -10, high = 10;
  for (; !tooWeak(low) && low > -300; low -= 20) high = low;
  for (; tooWeak(high) && high < 300; high += 20) low = high;
  while (high - low > 1e-10) {
    const double middle = (low + high) / 2;
    (tooWeak(middle) ? low : high) = middle;
  }
  return (low + high) / 2;
}

double albersheimSnrDb(const Detector& detector, double probability) {
  check(detector);
  checkProbability(detector, probability);
  const double a = std::log(0.62 / detector.false_alarm_probability);
  const double b = std::log(probability / (1 - probability));
  const double n = detector.pulses;
  return -5 * std::log10(n) + (6.2 + 4.54 / std::sqrt(n + 0.44)) * std::log10(a + 0.12 * a * b + 1.7 * b);
}

double shnidmanSnrDb(const Detector& detector, double probability) {
  check(detector);
  checkProbability(detector, probability);
  const double n = detector.pulses;
  const double pfa = detector.false_alarm_probability;
  const double pd = probability;
  const double alpha = n < 40 ? 0 : 0.25;
  const double eta = std::sqrt(-0.8 * std::log(4 * pfa * (1 - pfa))) +
                     std::copysign(std::sqrt(-0.8 * std::log(4 * pd * (1 - pd))), pd - 0.5);
  const double steady = eta * (eta + 2 * std::sqrt(n / 2 + (alpha - 0.25)));
  const double shape = shapeOf(detector);
  double fluctuation_db = 0;
  if (shape > 0) {
    fluctuation_db = (((17.7006 * pd - 18.4496) * pd + 14.5339) * pd - 3.525) / shape;
    if (pd > 0.872) {
      fluctuation_db +=
          (std::exp(27.31 * pd - 25.14) + (pd - 0.8) * (0.7 * std::log(1e-5 / pfa) + (2 * n - 20) / 80)) /
          shape;
    }
  }
  return ratioToDb(steady / n) + fluctuation_db;
}

namespace {

double probabilityOfLogOdds(double log_odds) {
  return 1 / (1 + std::exp(-log_odds));
}

/// The inverse of albersheimSnrDb, as the logarithm of the odds of a detection.
double albersheimLogOdds(const Detector& detector, double snr_db) {
  const double a = std::log(0.62 / detector.false_alarm_probability);
  const double n = detector.pulses;
  const double z = (snr_db + 5 * std::log10(n)) / (6.2 + 4.54 / std::sqrt(n + 0.44));
  return (std::pow(10.0, z) - a) / (1.7 + 0.12 * a);
}

/// Albersheim's formula in its range of probabilities; below, the exact probability of a steady target at a
/// signal-to-noise ratio that is shifted so that both meet.
class Albersheim {
 public:
  explicit Albersheim(const Detector& detector)
      : steady_(detector), threshold_(detectionThreshold(detector)) {
    steady_.swerling = Swerling::steady;
    // With many false alarms the formula's minimum is above its range.
    const double minimum_log_odds = albersheimLogOdds(steady_, -std::numeric_limits<double>::infinity());
    lowest_log_odds_ = std::max(std::log(kLowest / (1 - kLowest)), minimum_log_odds + 0.4);
    lowest_ = probabilityOfLogOdds(lowest_log_odds_);
    shift_db_ = emfield::requiredSnrDb(steady_, lowest_) - albersheimSnrDb(steady_, lowest_);
  }

  double probability(double snr_db) const {
    const double log_odds = albersheimLogOdds(steady_, snr_db);
    if (log_odds >= lowest_log_odds_) return probabilityOfLogOdds(log_odds);
    return detectionProbability(steady_, threshold_, dbToRatio(snr_db + shift_db_));
  }

  /// The inverse of probability().
  double requiredSnrDb(double probability) const {
    return probability < lowest_ ? emfield::requiredSnrDb(steady_, probability) - shift_db_
                                 : albersheimSnrDb(steady_, probability);
  }

 private:
  static constexpr double kLowest = 0.1;
  Detector steady_;
  double threshold_;
  double lowest_log_odds_, lowest_;  ///< of the formula's range
  double shift_db_;
};

}  // namespace

double albersheimProbability(const Detector& detector, double snr_db) {
  return Albersheim(detector).probability(snr_db);
}

double shnidmanProbability(const Detector& detector, double snr_db) {
  // In log-odds, for accuracy at both ends.
  const double pfa = detector.false_alarm_probability;
  double low = std::log(pfa / (1 - pfa)) + 1e-9, high = 30;
  while (high - low > 1e-9) {
    const double middle = (low + high) / 2;
    (shnidmanSnrDb(detector, probabilityOfLogOdds(middle)) <= snr_db ? low : high) = middle;
  }
  return probabilityOfLogOdds(low);
}

double requiredSnrDb(const Detector& detector, scenario::DetectionMethod method, double probability) {
  switch (method) {
    case scenario::DetectionMethod::albersheim:
      return Albersheim(detector).requiredSnrDb(probability);
    case scenario::DetectionMethod::shnidman:
      return shnidmanSnrDb(detector, probability);
    case scenario::DetectionMethod::exact:
      break;
  }
  return requiredSnrDb(detector, probability);
}

DetectionCurve::DetectionCurve(const Detector& detector, scenario::DetectionMethod method, double loss_db,
                               bool blanks)
    : detector_(detector), method_(method), loss_db_(loss_db) {
  const double threshold = detectionThreshold(detector);
  std::optional<Albersheim> albersheim;
  if (method == scenario::DetectionMethod::albersheim) albersheim.emplace(detector);
  const auto probabilityAt = [&](double snr_db) {
    switch (method) {
      case scenario::DetectionMethod::albersheim:
        return albersheim->probability(snr_db);
      case scenario::DetectionMethod::shnidman:
        return shnidmanProbability(detector, snr_db);
      case scenario::DetectionMethod::exact:
        break;
    }
    return detectionProbability(detector, threshold, dbToRatio(snr_db));
  };
  // Above the last knot the curve is flat; the error is a fifth of the stated accuracy. The same is the error
  // of the first step, below which there are only false alarms: looks add up, so that their probability
  // counts as such.
  constexpr double kTail = 2e-5;
  constexpr double kPrecision = 1e-9;
  const double pfa = detector.false_alarm_probability;
  const double low = requiredSnrDb(detector, pfa + kTail);
  const double last = requiredSnrDb(detector, 1 - kTail);
  constexpr double kStep_db = 0.1;
  const int upper = std::max(3, int(std::ceil((last - low) / kStep_db)));
  const double step_db = (last - low) / upper;
  const double lowest = requiredSnrDb(detector, pfa + std::clamp(pfa, kPrecision, kTail));
  const int lower = 1 + int(std::ceil((low - lowest) / step_db));
  const int count = lower + upper + 1;
  const double first = low - lower * step_db;
  first_snr_db_ = float(first + loss_db);
  steps_per_db_ = float(1 / step_db);
  std::vector<double> values = {pfa};
  for (int i = 1; i < count; ++i) {
    values.push_back(std::max(probabilityAt(low + (i - lower) * step_db), values.back()));
  }
  for (int i = 0; i < count; ++i) {
    const double before = i > 0 ? values[i] - values[i - 1] : 0;
    const double after = i + 1 < count ? values[i + 1] - values[i] : 0;
    knots_.push_back({float(values[i]), float(monotoneRise(before, after))});
  }
  if (blanks) addRows();
}

void DetectionCurve::addRows() {
  const int pulses = detector_.pulses;
  // Numbers of open pulses: all up to 12, then in steps of a seventh.
  std::vector<int> numbers;
  for (int n = 1; n < pulses; n = std::max(n + 1, int(n > 12 ? n * 1.15 : n))) numbers.push_back(n);
  numbers.push_back(pulses);
  constexpr int kVariances = BlankedCurveView::kVariances;
  const auto thresholdOf = [this](int number) {
    return detectionThreshold({detector_.swerling, number, detector_.false_alarm_probability});
  };
  constexpr double kAboveThreshold_db = 29;  // 0.999 of single pulses of noise
  row_means_ =
      1 + int(std::ceil((ratioToDb(thresholdOf(1)) + kAboveThreshold_db - kFirstMean_db) / kMeanStep_db));
  const std::size_t size = std::size_t(kVariances) * row_means_;
  std::vector<std::vector<double>> of_numbers;
  for (const int number : numbers) {
    const double threshold = thresholdOf(number);
    std::vector<double>& values = of_numbers.emplace_back();
    for (int v = 0; v < kVariances; ++v) {
      const double shape = number * std::exp2(-v - BlankedCurveView::kLeast_octaves);
      for (int i = 0; i < row_means_; ++i) {
        const double mean = number * dbToRatio(kFirstMean_db + i * kMeanStep_db);
        values.push_back(gammaAbove(shape, shape * threshold / mean));
      }
    }
  }
  // Down to one open pulse in 50 looks.
  const int rows = 2 + int(double(BlankedCurveView::kRowsPerOctave) * std::log2(50.0 * pulses));
  rows_.reserve(rows * size);
  for (int row = 0; row < rows; ++row) {
    const double open = std::exp2(-row / double(BlankedCurveView::kRowsPerOctave));
    const double mean = pulses * open, reach = 8 * std::sqrt(mean * (1 - open)) + 8;
    std::vector<double> weights(numbers.size());
    for (int n = std::max(1, int(mean - reach)); n <= std::min(pulses, int(mean + reach)); ++n) {
      const double probability =
          open == 1 ? double(n == pulses)
                    : std::exp(logFactorial(pulses) - logFactorial(n) - logFactorial(pulses - n) +
                               n * std::log(open) + (pulses - n) * std::log1p(-open));
      const std::size_t above = std::lower_bound(numbers.begin(), numbers.end(), n) - numbers.begin();
      const double part =
          numbers[above] == n ? 1 : double(n - numbers[above - 1]) / (numbers[above] - numbers[above - 1]);
      weights[above] += part * probability;
      if (part < 1) weights[above - 1] += (1 - part) * probability;
    }
    std::vector<double> values(size, 0.0);
    for (std::size_t n = 0; n < numbers.size(); ++n) {
      if (weights[n] < 1e-9) continue;
      for (std::size_t i = 0; i < size; ++i) values[i] += weights[n] * of_numbers[n][i];
    }
    rows_.insert(rows_.end(), values.begin(), values.end());
  }
}

}  // namespace emscape::emfield
