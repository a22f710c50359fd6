#include "playback/stream/live_battlefield.h"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <deque>
#include <mutex>
#include <thread>
#include <utility>

#include "base/event.h"
#include "base/geodesy/position_limits.h"
#include "base/text/count_text.h"
#include "emscape/base/error.h"
#include "emscape/base/work.h"
#include "interop/live/live_acmi.h"
#include "interop/live/live_cot.h"
#include "interop/live/live_dis.h"
#include "playback/live/first_line.h"
#include "playback/sockets/socket.h"
#include "playback/stream/live_scenario.h"
#include "playback/stream/steady_time.h"
#include "playback/stream/stream_recorder.h"
#include "recording/acmi/acmi_handshake.h"

namespace emscape::playback {
namespace {

constexpr double kExpire_s = 0.25;      ///< between two searches for what has timed out
constexpr double kWake_s = 1.0 / 60;    ///< between two calls of `wake`
constexpr double kRebuild_s = 0.5;      ///< between two scenarios; longer if one takes long
constexpr double kRebuildPart = 0.1;    ///< of the time that making scenarios may take
constexpr double kPoll_s = 0.1;         ///< longest wait for data, and for the end
constexpr double kReckon_s = 1.0 / 30;  ///< between two poses of platforms that move without data
constexpr double kReconnect_s = 2;
constexpr double kHostGreets_s = 4;  ///< in which a host must greet
/// Smallest movements that are shown.
constexpr double kMoved_deg = 1e-8, kMoved_m = 1e-3, kTurned_deg = 1e-3;

bool hasMoved(const std::vector<NamedPose>& a, const std::vector<NamedPose>& b) {
  return !std::equal(a.begin(), a.end(), b.begin(), b.end(), [](const NamedPose& p, const NamedPose& q) {
    const auto near = [](double x, double y, double limit) { return std::abs(x - y) <= limit; };
    return near(p.position.latitude_deg, q.position.latitude_deg, kMoved_deg) &&
           near(p.position.longitude_deg, q.position.longitude_deg, kMoved_deg) &&
           near(p.position.height_msl_m.value_or(0), q.position.height_msl_m.value_or(0), kMoved_m) &&
           near(p.attitude.heading_deg, q.attitude.heading_deg, kTurned_deg) &&
           near(p.attitude.pitch_deg, q.attitude.pitch_deg, kTurned_deg) &&
           near(p.attitude.roll_deg, q.attitude.roll_deg, kTurned_deg) && p.platform == q.platform &&
           p.is_present == q.is_present;
  });
}

/// Records per second over the last second or two.
class Rate {
 public:
  void note(double time_s, long long records) {
    if (!marks_.empty() && time_s - marks_.back().first < 0.1) return;
    marks_.emplace_back(time_s, records);
    while (marks_.size() > 2 && time_s - marks_.front().first > 2) marks_.pop_front();
  }
  double perSecond(double time_s, long long records) const {
    if (marks_.empty() || time_s - marks_.back().first > 2) return 0;
    const double span_s = std::max(time_s - marks_.front().first, 0.1);
    return static_cast<double>(records - marks_.front().second) / span_s;
  }

 private:
  std::deque<std::pair<double, long long>> marks_;
};

}  // namespace

const StreamFormat& formatOf(StreamKind kind) {
  // Heartbeats of DIS are 5 s apart; devices of TAK tell their place once a minute where they stand.
  static const StreamFormat formats[] = {{"DIS", ".pcap", "PDU", "PDU", "entity", "entities", 6},
                                         {"ACMI", ".acmi", "line", "lines", "object", "objects", 6},
                                         {"CoT", ".cot", "event", "events", "object", "objects", 90}};
  return formats[static_cast<std::size_t>(kind)];
}

std::string StreamStatus::text() const {
  const StreamFormat& format = formatOf(kind);
  std::string text = std::string(format.name) + ": ";
  if (!age_s) {
    text += fmt::format("no {} yet", format.record);
  } else {
    text += fmt::format("{:.0f} {}/s, {}, last {:.{}f} s ago", records_per_s, format.plural,
                        countText(entities, format.object, format.objects), *age_s, *age_s < 10 ? 1 : 0);
  }
  const auto add = [&text](const char* what, const std::vector<std::string>& platforms) {
    if (platforms.empty()) return;
    text += "; ";
    text += what;
    text += platforms.size() > 2 ? countText(platforms.size(), "platform", "platforms")
                                 : fmt::format("{}", fmt::join(platforms, ", "));
  };
  add("silent at the last known place: ", silent);
  if (age_s) add("not told of, as in the scenario: ", untold);
  return trouble.empty() ? text : text + "; " + trouble;
}

struct LiveBattlefield::Impl {
  const StreamRequest request;
  std::mutex wake_mutex;
  std::function<void()> wake;  ///< with the mutex
  long long wake_number = 0;   ///< of the function, with the mutex

  LiveScenarioMaker maker;

  // Of the receiver's thread.
  std::optional<DatagramReceiver> datagrams;
  std::optional<Connection> connection;
  double connected_s = 0;
  long long told_revision = 0;
  bool is_due = false;     ///< something has come that is not told yet
  bool is_moving = false;  ///< without data, by dead reckoning
  double told_s = 0, expired_s = 0;

  /// Held while records are read and written to the disk; the builder's thread takes the objects.
  std::mutex state_mutex;
  std::unique_ptr<interop::LiveState> state;
  std::unique_ptr<StreamRecorder> recorder;
  long long generation = 0;  ///< of the state: a new one after each connection
  StreamStatus received;     ///< bytes, and the records of earlier states
  std::optional<double> last_s;

  /// Of what is told; held only to copy it: the window's thread takes it in each frame.
  mutable std::mutex mutex;
  std::shared_ptr<const LiveScenario> scenario;
  long long scenario_generation = 0;
  NamedPosesPtr poses = std::make_shared<const std::vector<NamedPose>>();
  StreamStatus told;  ///< without rate, age and trouble
  std::optional<double> told_last_s;
  Rate rate;
  std::string first_bad, connection_trouble, build_trouble, recording_trouble;
  double lost_at_s = -1e18;

  StopFlag stops{false};
  Event rebuild;
  std::thread receiver, builder;

  Impl(const StreamRequest& asked, std::function<void()> wake_in)
      : request(asked), wake(std::move(wake_in)), maker(asked), scenario(maker.base()) {
    if (!request.record.empty())
      recorder =
          std::make_unique<StreamRecorder>(request.record, formatOf(request.kind).ending, request.replaces);
    if (request.connects) {
      connect(request.stop);
    } else {
      datagrams.emplace(request.address, request.interface);
    }
    maker.writeBase();
    restart();
    try {
      receiver = std::thread([this] { request.connects ? receiveText() : receiveDatagrams(); });
      builder = std::thread([this] { build(); });
    } catch (...) {
      finish();
      throw;
    }
  }

  ~Impl() { finish(); }

  void finish() {
    stops = true;
    rebuild.set();
    for (std::thread* thread : {&receiver, &builder})
      if (thread->joinable()) thread->join();
  }

  void restart() {
    const std::lock_guard<std::mutex> lock(state_mutex);
    if (state) {
      received.records += state->counts().records;
      told_revision = -1;  // the scenario is of the state before
    }
    if (request.kind == StreamKind::dis) {
      state = std::make_unique<interop::LiveDis>(request.read);
    } else if (request.kind == StreamKind::acmi) {
      state = std::make_unique<interop::LiveAcmi>();
    } else {
      state = std::make_unique<interop::LiveCot>(request.connects);
    }
    ++generation;
  }

  void tell() {
    const std::lock_guard<std::mutex> lock(wake_mutex);
    if (wake) wake();
  }

  /// Takes what has arrived.
  void take(const std::uint8_t* data, std::size_t size) {
    const std::lock_guard<std::mutex> lock(state_mutex);
    const double now_s = steadyTime_s();
    const long long before = state->counts().records;
    state->take(data, size, now_s);
    if (state->counts().records != before) last_s = now_s;
    received.bytes += static_cast<long long>(size);
    if (recorder) recorder->write(data, size, unixTime_s());
    is_due = true;
  }

  /// Seconds until publish() does something.
  double patience_s() const {
    const double pace_s = is_due ? kWake_s : is_moving ? kReckon_s : kPoll_s;
    return std::max(0.0, pace_s - (steadyTime_s() - told_s));
  }

  /// Tells what has arrived and where the platforms are now, as often as it may.
  void publish() {
    if (patience_s() > 0) return;
    const double time_s = told_s = steadyTime_s();
    std::unique_lock<std::mutex> lock(mutex);
    const std::shared_ptr<const LiveScenario> of = scenario;
    const NamedPosesPtr before = poses;
    const bool is_of_state = scenario_generation == generation;
    lock.unlock();
    std::vector<interop::LivePose> live;
    std::unique_lock<std::mutex> state_lock(state_mutex);
    if (request.kind == StreamKind::acmi || time_s - expired_s > kExpire_s) {
      state->expire(time_s);
      expired_s = time_s;
    }
    const interop::LiveCounts counts = state->counts();
    const bool is_other =
        counts.records > 0 && std::exchange(told_revision, state->revision()) != state->revision();
    if (is_of_state) live = state->poses(time_s);
    StreamStatus now = received;
    now.entities = state->objectCount();
    const std::optional<double> arrival_s = last_s;
    if (recorder) recorder->keepUp();
    const std::string failure = recorder ? recorder->failure() : "";
    state_lock.unlock();
    if (is_other) rebuild.set();
    now.records += counts.records;
    now.bad = counts.bad;
    now.late = counts.late;
    now.duplicates = counts.duplicates;
    now.outside = counts.outside;
    now.forgotten = counts.forgotten;
    if (datagrams) now.lost = static_cast<long long>(datagrams->lost());
    std::vector<NamedPose> moved = *before;
    movePoses(*of, live, moved);
    const bool has_moved = hasMoved(*before, moved);
    lock.lock();
    if (now.lost != told.lost) lost_at_s = time_s;
    told = now;
    told_last_s = arrival_s;
    if (arrival_s) rate.note(*arrival_s, now.records);
    first_bad = counts.first_bad;
    recording_trouble = failure;
    if (datagrams) connection_trouble = datagrams->failure();
    is_moving = has_moved && poses == before;  // else another scenario has come
    if (is_moving) poses = std::make_shared<const std::vector<NamedPose>>(std::move(moved));
    lock.unlock();
    if (std::exchange(is_due, false)) tell();
  }

  void receiveDatagrams() {
    while (!stops) {
      datagrams->receive(patience_s(),
                         [this](const std::uint8_t* data, std::size_t size) { take(data, size); });
      publish();
    }
  }

  void connect(const StopFlag* stop) {
    connection.emplace(Connection::to(request.address, stop));
    connected_s = steadyTime_s();
    connection->write(request.kind == StreamKind::acmi ? interop::acmiClientHello("Emscape", request.password)
                                                       : interop::cotPing("emscape", unixTime_s()),
                      1);
  }

  /// Servers of TAK begin with events.
  bool hasNoGreeting() const { return request.kind != StreamKind::acmi; }

  void fail(const std::string& text) {
    connection.reset();
    {
      const std::lock_guard<std::mutex> lock(state_mutex);
      if (recorder) recorder->flush();
    }
    is_due = true;
    told_s = 0;  // at once
    const std::lock_guard<std::mutex> lock(mutex);
    connection_trouble = text + fmt::format("; trying again every {:.0f} s", kReconnect_s);
  }

  void reconnect() {
    for (double until_s = steadyTime_s() + kReconnect_s; steadyTime_s() < until_s && !stops;)
      std::this_thread::sleep_for(std::chrono::milliseconds(50));
    if (stops) return;
    try {
      connect(&stops);
      restart();
      const std::lock_guard<std::mutex> lock(mutex);
      connection_trouble.clear();
    } catch (const Error& error) {
      fail(error.message());
    } catch (const Stopped&) {
    }
  }

  void receiveText() {
    std::vector<char> buffer(std::size_t{1} << 16);
    std::string hello;
    bool is_greeted = hasNoGreeting();
    while (!stops) {
      if (!connection) {
        hello.clear();
        is_greeted = hasNoGreeting();
        publish();
        reconnect();
        continue;
      }
      const auto count = connection->read(patience_s(), buffer.data(), buffer.size());
      if (!count) {
        fail(is_greeted ? "the host has ended the stream"
                        : "the host has ended the connection at the handshake (a wrong password?)");
        continue;
      }
      std::size_t begin = 0;
      while (!is_greeted && begin < *count) {
        const char c = buffer[begin++];
        if (c != '\0') {
          hello += c;
        } else {
          is_greeted = true;
        }
        constexpr std::size_t kLongestHello = 4096;
        if (!is_greeted && hello.size() < kLongestHello) continue;
        const std::string fault = interop::acmiHostFault(hello);
        if (fault.empty() && is_greeted) break;
        fail(fault.empty() ? "the host's greeting has no end" : fault);
        begin = *count;
        break;
      }
      if (connection && !is_greeted && steadyTime_s() - connected_s > kHostGreets_s)
        fail(fmt::format("no greeting in {:.0f} s: is {} a host of Tacview's real-time telemetry?",
                         kHostGreets_s, request.address.text()));
      if (!connection) continue;
      if (begin < *count) take(reinterpret_cast<const std::uint8_t*>(buffer.data()) + begin, *count - begin);
      publish();
    }
  }

  /// Makes scenarios of what has changed.
  void build() {
    double not_before_s = 0;
    long long built_generation = 0, built_revision = 0;
    while (!stops) {
      rebuild.wait();
      while (!stops && steadyTime_s() < not_before_s)
        std::this_thread::sleep_for(std::chrono::milliseconds(20));
      if (stops) return;
      const double begin_s = steadyTime_s();
      interop::LiveRecording recording;
      {
        const std::lock_guard<std::mutex> lock(state_mutex);
        if (built_generation == generation && built_revision == state->revision()) continue;
        built_generation = generation;
        built_revision = state->revision();
        recording = state->recording(begin_s);
      }
      std::shared_ptr<const LiveScenario> made;
      std::vector<NamedPose> moved;
      std::string trouble;
      const NamedPosesPtr before = now().poses;
      try {
        made = maker.make(std::move(recording), *before);
        std::vector<interop::LivePose> live;
        {
          const std::lock_guard<std::mutex> lock(state_mutex);
          if (built_generation == generation) live = state->poses(steadyTime_s());
        }
        moved = made->poses;
        movePoses(*made, live, moved);
      } catch (const std::exception& error) {
        trouble = "the objects cannot be shown: " + failureLine(error);
      }
      {
        const std::lock_guard<std::mutex> lock(mutex);
        if (made) {
          scenario = std::move(made);
          scenario_generation = built_generation;
          poses = std::make_shared<const std::vector<NamedPose>>(std::move(moved));
        }
        build_trouble = std::move(trouble);
      }
      tell();
      not_before_s = steadyTime_s() + std::max(kRebuild_s, (steadyTime_s() - begin_s) / kRebuildPart);
    }
  }

  BattlefieldNow now() const {
    const std::lock_guard<std::mutex> lock(mutex);
    return {scenario->loaded.scenario, poses, told_last_s.value_or(0), hasStopped()};
  }

  /// With the mutex.
  bool hasStopped() const {
    return told_last_s && steadyTime_s() - *told_last_s > formatOf(request.kind).silence_s;
  }

  StreamStatus status() const {
    const std::lock_guard<std::mutex> lock(mutex);
    const double time_s = steadyTime_s();
    StreamStatus result = told;
    result.kind = request.kind;
    result.emitters = static_cast<std::size_t>(scenario->emitters);
    result.unmatched = scenario->unmatched;
    result.silent = scenario->silent;
    result.untold = scenario->untold;
    result.records_per_s = rate.perSecond(time_s, result.records);
    if (told_last_s) result.age_s = time_s - *told_last_s;
    const auto add = [&result](const std::string& text) {
      if (text.empty()) return;
      result.trouble += (result.trouble.empty() ? "" : "; ") + text;
    };
    add(connection_trouble);
    if (connection_trouble.empty() && hasStopped()) add("the stream has stopped");
    if (time_s - lost_at_s < 5)
      add(fmt::format("it comes faster than it can be read, {} lost",
                      countText(result.lost, "datagram", "datagrams")));
    if (result.bad > 0)
      add(fmt::format("{} cannot be read, the first: {}", countText(result.bad, "record", "records"),
                      first_bad));
    if (result.outside > 0)
      add(fmt::format("{} higher than {:.0f} km or lower than {:.0f} km, not used",
                      countText(result.outside, "position is", "positions are"),
                      PositionLimits::kHighest_m / 1000, PositionLimits::kLowest_m / 1000));
    if (result.forgotten > 0)
      add(fmt::format("more than {} objects or {} beams: {} forgotten", interop::LiveLimits::kObjects,
                      interop::LiveLimits::kBeams, result.forgotten));
    add(build_trouble);
    add(recording_trouble);
    return result;
  }
};

LiveBattlefield::LiveBattlefield(const StreamRequest& request, std::function<void()> wake)
    : impl_(std::make_unique<Impl>(request, std::move(wake))) {}
LiveBattlefield::~LiveBattlefield() {
  try {
    finishRecording();
  } catch (const Error&) {  // finishRecording() reports it
  }
}

std::shared_ptr<void> LiveBattlefield::setWake(std::function<void()> wake) {
  const std::lock_guard<std::mutex> lock(impl_->wake_mutex);
  impl_->wake = std::move(wake);
  const long long number = ++impl_->wake_number;
  return {nullptr, [impl = impl_.get(), number](void*) {
            const std::lock_guard<std::mutex> ending(impl->wake_mutex);
            if (impl->wake_number == number) impl->wake = {};
          }};
}

BattlefieldNow LiveBattlefield::now() const {
  return impl_->now();
}
StreamStatus LiveBattlefield::status() const {
  return impl_->status();
}
std::string LiveBattlefield::file() const {
  return impl_->maker.file();
}
void LiveBattlefield::finishRecording() {
  const std::lock_guard<std::mutex> lock(impl_->state_mutex);
  if (impl_->recorder) impl_->recorder->finish();
}

}  // namespace emscape::playback
