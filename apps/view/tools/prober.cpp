#include "apps/view/tools/prober.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "base/text/failure_text.h"
#include "base/text/shell_word.h"
#include "emfield/link/path_report.h"
#include "emscape/base/error.h"
#include "playback/editing/edit_history.h"
#include "playback/editing/pick.h"
#include "scenario/model/named_items.h"

namespace emscape::view {
namespace {

/// Height above the ground at which the cursor reads there; a map layer has its own.
constexpr double kAboveGround_m = 10;

/// True if a locked point must be read again.
bool isOtherField(const playback::LivePicture& a, const playback::LivePicture& b) {
  return !sameValues(a, b) || a.info().time_s != b.info().time_s || a.scenario != b.scenario;
}

/// The value of the isosurface that a picture shows; none in the other modes.
std::optional<double> isoValueOf(const playback::LivePicture& picture) {
  if (picture.settings.mode != render::CompositingMode::iso) return std::nullopt;
  const double value = picture.settings.iso_value;
  return std::isnan(value) ? 0.5 * (picture.transfer.lowest() + picture.transfer.highest()) : value;
}

}  // namespace

/// Reads a probe; keeps the last volume in host memory.
class Prober::Reader {
 public:
  explicit Reader(Detail detail) : detail_(detail) {}

  Answer operator()(const Question& question) {
    const playback::LivePicture& picture = *question.picture;
    Answer answer;
    answer.lock = question.lock;
    ProbeResult& result = answer.result;
    const bool is_beside =
        picture.beside && (question.pixel ? question.pixel->x < picture.split_column : question.is_beside);
    result.is_beside = is_beside;
    result.scenario = is_beside ? nullptr : picture.scenario;
    result.quantity = picture.info().quantity;
    result.floor = picture.info().floor;
    result.time_s = picture.info().time_s;
    try {
      const volume::DenseVolume& volume = is_beside ? besideOf(picture) : hostOf(question.picture);
      std::optional<Vec3d> position_m = question.position_m;
      if (question.pixel) {
        const auto picked =
            playback::pick(picture.camera, picture.box, picture.size, question.pixel->x, question.pixel->y,
                           volume, picture.ground.get(), picture.settings.planes, isoValueOf(picture));
        position_m.reset();
        if (picked) {
          position_m = picked->on == playback::PickedPoint::On::ground
                           ? playback::aboveGround(picked->position_m,
                                                   picture.settings.map_height_agl_m.value_or(kAboveGround_m),
                                                   volume, picture.terrain.get())
                           : picked->position_m;
        }
      }
      if (position_m) {
        result.reading =
            playback::probe(*position_m, volume, detail_ == Detail::explained ? result.scenario : nullptr,
                            picture.terrain.get());
        if (!picture.has_field) result.reading->text = "no field yet";
        if (picture.status.column_step > 1) {  // interpolated columns state no values
          result.reading->sample.kind = playback::VolumeSample::Kind::masked;
          result.reading->text = "computed when the field rests";
        }
        result.contributions = contributionsOf(*result.reading, result.quantity);
      }
    } catch (const std::exception& error) {
      result.error = failureText(error);
    }
    return answer;
  }

 private:
  const volume::DenseVolume& hostOf(const PicturePtr& picture) {
    if (picture->cells) throw Error(ErrorCode::usage, "fields on tetrahedra are not probed");
    if (!picture_ || isOtherField(*picture_, *picture)) host_ = picture->volume.host();
    picture_ = picture;
    return *host_;
  }

  const volume::DenseVolume& besideOf(const playback::LivePicture& picture) {
    if (beside_of_ != picture.beside) beside_ = picture.beside->volume.host();
    beside_of_ = picture.beside;
    return *beside_;
  }

  const Detail detail_;
  PicturePtr picture_;
  std::shared_ptr<const volume::DenseVolume> host_;
  std::shared_ptr<const playback::Frame> beside_of_;
  std::shared_ptr<const volume::DenseVolume> beside_;
};

Prober::Prober(Detail detail, std::function<void()> wake)
    : reader_(std::make_shared<Reader>(detail)), task_(std::move(wake)) {}

void Prober::turnOn(bool on) {
  if (std::exchange(is_on_, on) != on) is_due_ = on;
}

void Prober::hover(std::optional<render::Projected> pixel) {
  if (is_locked_ && !locked_m_) return;  // the pixel to lock is still being read
  std::optional<Pixel> at;
  if (pixel) at = Pixel{pixel->x, pixel->y};
  const bool is_same =
      at.has_value() == pixel_.has_value() && (!at || (at->x == pixel_->x && at->y == pixel_->y));
  if (is_same) return;
  pixel_ = at;
  if (!is_locked_ && at) is_due_ = true;
}

void Prober::lockAtPixel(double x, double y) {
  pixel_ = Pixel{x, y};
  is_locked_ = is_due_ = true;
  locked_m_.reset();
  ++lock_;
}

void Prober::lockAt(const Vec3d& position_m) {
  is_locked_ = is_due_ = true;
  locked_m_ = position_m;
  locked_beside_ = false;
  ++lock_;
}

void Prober::toggleLock() {
  if (is_locked_) return unlock();
  if (result_ && result_->reading) {
    lockAt(result_->reading->position_m);
    locked_beside_ = result_->is_beside;
  } else if (pixel_) {
    lockAtPixel(pixel_->x, pixel_->y);
  }
}

void Prober::unlock() {
  is_locked_ = false;
  locked_m_.reset();
  is_due_ = pixel_.has_value();
  ++lock_;
}

void Prober::ask(const PicturePtr& picture) {
  is_due_ = false;
  Question question{picture, std::nullopt, {}, lock_};
  if (locked_m_) {
    question.position_m = *locked_m_;
    question.is_beside = locked_beside_;
  } else if (pixel_) {
    question.pixel = pixel_;
  } else if (!is_locked_ && result_ && result_->reading) {  // the cursor has left the picture
    question.position_m = result_->reading->position_m;
    question.is_beside = result_->is_beside;
  } else {
    return;
  }
  asked_picture_ = picture;
  task_.start([reader = reader_, question = std::move(question)] { return (*reader)(question); });
}

bool Prober::update(const PicturePtr& picture) {
  bool is_new = false;
  if (task_.done()) {
    Answer answer = task_.take();
    if (answer.lock == lock_) {
      if (is_locked_ && !locked_m_) {
        if (answer.result.reading) {
          locked_m_ = answer.result.reading->position_m;
          locked_beside_ = answer.result.is_beside;
        } else {
          is_locked_ = false;
        }
      }
      result_ = std::move(answer.result);
      is_new = true;
    }
  }
  if (!is_on_ || !picture || task_.active()) return is_new;
  const bool is_at_pixel = pixel_ && !locked_m_;
  const bool is_stale =
      !asked_picture_ || (is_at_pixel ? asked_picture_ != picture : isOtherField(*asked_picture_, *picture));
  if (is_due_ || is_stale) ask(picture);
  return is_new;
}

std::optional<double> pointValueOf(const ProbeResult& result) {
  using Kind = playback::VolumeSample::Kind;
  if (!result.reading || !result.scenario || result.contributions.empty()) return std::nullopt;
  const auto& output = result.scenario->output;
  const Kind kind = result.reading->sample.kind;
  if (output.interval.kind != scenario::IntervalKind::instant) return std::nullopt;
  if (kind != Kind::value && kind != Kind::at_floor) return std::nullopt;
  const bool is_sum =
      result.quantity == "power_density_dbwm2" && output.combine == scenario::CombineMode::sum;
  double strongest = -std::numeric_limits<double>::infinity(), sum_w = 0;
  bool has_quantity = false;
  for (const Contribution& each : result.contributions) {
    if (!result.reading->emitters[each.emitter].budget) return std::nullopt;
    if (!each.is_of_quantity) continue;
    has_quantity = true;
    strongest = std::max(strongest, each.value);
    sum_w += std::pow(10, each.value / 10);
  }
  if (!has_quantity) return std::nullopt;
  const double value = is_sum ? 10 * std::log10(sum_w) : strongest;
  return value > static_cast<double>(result.floor) ? value : -std::numeric_limits<double>::infinity();
}

PointField pointFieldOf(const ProbeResult& result) {
  const std::optional<double> point = pointValueOf(result);
  if (!point) return PointField::same;
  const bool has_volume = result.reading->sample.kind == playback::VolumeSample::Kind::value;
  if (std::isinf(*point)) return has_volume ? PointField::of_volume_only : PointField::same;
  if (!has_volume) return PointField::differs;
  // Other quantities are not the strongest of the emitters' contributions.
  const bool is_comparable = result.quantity == "power_density_dbwm2" || result.quantity == "snr_db";
  constexpr double kNoticeable_db = 3;
  const double apart_db = std::abs(*point - static_cast<double>(result.reading->sample.value));
  return is_comparable && apart_db > kNoticeable_db ? PointField::differs : PointField::same;
}

std::vector<Contribution> contributionsOf(const playback::ProbeReading& reading,
                                          const std::string& quantity) {
  std::vector<Contribution> contributions;
  for (std::size_t e = 0; e < reading.emitters.size(); ++e) {
    const playback::EmitterProbe& emitter = reading.emitters[e];
    Contribution contribution{e, -std::numeric_limits<double>::infinity(), "", emitter.refusal};
    if (emitter.budget && !emitter.budget->active) {
      contribution.text = "off";
    } else if (emitter.budget) {
      const emfield::BudgetTerm* term = emitter.budget->find(quantity);
      contribution.is_of_quantity = term != nullptr;
      if (term == nullptr) term = emitter.budget->find("power_density_dbwm2");
      contribution.value = term->value;
      contribution.text = std::isinf(term->value) ? "no field" : emfield::valueText(term->value);
      if (!std::isinf(term->value)) contribution.unit = term->unit;
      if (!contribution.unit.empty()) contribution.text += " " + contribution.unit;
    }
    contributions.push_back(std::move(contribution));
  }
  std::stable_sort(contributions.begin(), contributions.end(),
                   [](const Contribution& a, const Contribution& b) { return a.value > b.value; });
  return contributions;
}

std::string profileCommand(const ProbeResult& result, const std::string& emitter) {
  if (!result.scenario || !result.reading || !result.reading->position) {
    throw Error(ErrorCode::bad_input, "there is no path to explain: the probe has no point of a scenario");
  }
  scenario::indexOfNamed(result.scenario->emitters, emitter, "emitter");  // throws if there is none
  const GeodeticPosition& position = *result.reading->position;
  return fmt::format("{} --emitter {} --to={:.7f},{:.7f},{:.2f} --time {}",
                     playback::commandText("profile", *result.scenario), shellWord(emitter),
                     position.latitude_deg, position.longitude_deg, *result.reading->height_msl_m,
                     result.time_s);
}

}  // namespace emscape::view
