#include "playback/stream/live_battlefield.h"

#include <fmt/format.h>

#include <algorithm>
#include <atomic>
#include <chrono>
#include <cmath>
#include <deque>
#include <mutex>
#include <thread>
#include <utility>

#include "base/event.h"
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

using SteadyClock = std::chrono::steady_clock;

constexpr double kExpire_s = 0.25;    ///< between two searches for what has timed out
constexpr double kWake_s = 1.0 / 60;  ///< between two calls of `wake`
constexpr double kRebuild_s = 0.5;    ///< between two scenarios; longer if one takes long
constexpr double kRebuildPart = 0.1;  ///< of the time that making scenarios may take
constexpr double kPoll_s = 0.1;       ///< longest wait for data, and for the end
constexpr double kReconnect_s = 2;
/// Smallest movements that are shown.
constexpr double kMoved_deg = 1e-8, kMoved_m = 1e-3, kTurned_deg = 1e-3;

double unixTime_s() {
  return std::chrono::duration<double>(std::chrono::system_clock::now().time_since_epoch()).count();
}

bool hasMoved(const std::vector<scenario::PlatformPose>& a, const std::vector<scenario::PlatformPose>& b) {
  return !std::equal(a.begin(), a.end(), b.begin(), b.end(),
                     [](const scenario::PlatformPose& p, const scenario::PlatformPose& q) {
                       const auto near = [](double x, double y, double limit) {
                         return std::abs(x - y) <= limit;
                       };
                       return p.platform == q.platform &&
                              near(p.position.latitude_deg, q.position.latitude_deg, kMoved_deg) &&
                              near(p.position.longitude_deg, q.position.longitude_deg, kMoved_deg) &&
                              near(*p.position.height_msl_m, *q.position.height_msl_m, kMoved_m) &&
                              near(p.attitude.heading_deg, q.attitude.heading_deg, kTurned_deg) &&
                              near(p.attitude.pitch_deg, q.attitude.pitch_deg, kTurned_deg) &&
                              near(p.attitude.roll_deg, q.attitude.roll_deg, kTurned_deg);
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
  return trouble.empty() ? text : text + "; " + trouble;
}

struct LiveBattlefield::Impl {
  const StreamRequest request;
  std::mutex wake_mutex;
  std::function<void()> wake;  ///< with the mutex

  LiveScenarioMaker maker;
  std::unique_ptr<StreamRecorder> recorder;  ///< of the receiver, with the mutex
  std::optional<DatagramReceiver> datagrams;
  std::optional<Connection> connection;

  mutable std::mutex mutex;  // of what follows, up to the threads
  std::unique_ptr<interop::LiveState> state;
  std::shared_ptr<const LiveScenario> scenario;
  PosesPtr poses;
  std::shared_ptr<const LiveScenario> posed_scenario;  ///< of the poses
  long long generation = 0;                            ///< of the state: a new one after each connection
  long long bytes = 0;
  long long foreign = 0;  ///< records of earlier states
  std::optional<double> last_s;
  Rate rate;
  std::string connection_trouble, build_trouble;
  std::uint64_t lost = 0;
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
    restart();
    receiver = std::thread([this] { request.connects ? receiveText() : receiveDatagrams(); });
    builder = std::thread([this] { build(); });
  }

  ~Impl() {
    stops = true;
    rebuild.set();
    receiver.join();
    builder.join();
  }

  void restart() {
    const std::lock_guard<std::mutex> lock(mutex);
    if (state) foreign += state->counts().records;
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

  /// Calls `wake` as often as it may.
  struct Waker {
    Impl& impl;
    double woken_s = 0;
    bool is_due = false;
    void update() {
      const double time_s = steadyTime_s();
      if (!is_due || time_s - woken_s <= kWake_s) return;
      woken_s = time_s;
      is_due = false;
      impl.tell();
    }
    double patience_s() const { return is_due ? kWake_s : kPoll_s; }
  };

  /// Takes what has arrived. The mutex is locked.
  void take(const std::uint8_t* data, std::size_t size, double arrival_s) {
    state->take(data, size, arrival_s);
    bytes += static_cast<long long>(size);
    last_s = arrival_s;
    rate.note(arrival_s, foreign + state->counts().records);
    if (recorder) recorder->write(data, size, unixTime_s());
  }

  void receiveDatagrams() {
    Waker waker{*this};
    long long revision = 0;
    double expired_s = 0;
    while (!stops) {
      const double arrival_s = steadyTime_s();
      const std::size_t count =
          datagrams->receive(waker.patience_s(), [&](const std::uint8_t* data, std::size_t size) {
            const std::lock_guard<std::mutex> lock(mutex);
            take(data, size, std::max(arrival_s, steadyTime_s()));
          });
      const double time_s = steadyTime_s();
      bool is_other = false;
      {
        const std::lock_guard<std::mutex> lock(mutex);
        if (time_s - expired_s > kExpire_s) {
          state->expire(time_s);
          expired_s = time_s;
        }
        if (datagrams->lost() != lost) lost_at_s = time_s;
        lost = datagrams->lost();
        is_other = std::exchange(revision, state->revision()) != state->revision();
      }
      if (is_other) rebuild.set();
      waker.is_due = waker.is_due || is_other || count > 0;
      waker.update();
    }
  }

  void connect(const StopFlag* stop) {
    connection.emplace(Connection::to(request.address, stop));
    connection->write(request.kind == StreamKind::acmi ? interop::acmiClientHello("Emscape", request.password)
                                                       : interop::cotPing("emscape", unixTime_s()),
                      1);
  }

  /// Servers of TAK begin with events.
  bool hasNoGreeting() const { return request.kind != StreamKind::acmi; }

  void fail(const std::string& text) {
    connection.reset();
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
    Waker waker{*this};
    std::vector<char> buffer(std::size_t{1} << 16);
    std::string hello;
    bool is_greeted = hasNoGreeting();
    long long revision = -1;
    double expired_s = 0;
    while (!stops) {
      if (!connection) {
        hello.clear();
        is_greeted = hasNoGreeting();
        waker.is_due = true;
        waker.update();
        reconnect();
        continue;
      }
      const auto count = connection->read(waker.patience_s(), buffer.data(), buffer.size());
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
      if (!connection) continue;
      bool is_other = false;
      const double time_s = steadyTime_s();
      {
        const std::lock_guard<std::mutex> lock(mutex);
        if (begin < *count) {
          take(reinterpret_cast<const std::uint8_t*>(buffer.data()) + begin, *count - begin, time_s);
          waker.is_due = true;
        }
        if (waker.is_due && time_s - expired_s > kWake_s) {
          state->expire(time_s);
          expired_s = time_s;
          is_other = std::exchange(revision, state->revision()) != state->revision();
        }
      }
      if (is_other) rebuild.set();
      waker.update();
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
        const std::lock_guard<std::mutex> lock(mutex);
        if (built_generation == generation && built_revision == state->revision()) continue;
        built_generation = generation;
        built_revision = state->revision();
        recording = state->recording(begin_s);
      }
      std::shared_ptr<const LiveScenario> made;
      std::string trouble;
      try {
        made = maker.make(std::move(recording));
      } catch (const std::exception& error) {
        trouble = "the objects cannot be shown: " + failureLine(error);
      }
      {
        const std::lock_guard<std::mutex> lock(mutex);
        if (made) scenario = std::move(made);
        build_trouble = std::move(trouble);
      }
      tell();
      not_before_s = steadyTime_s() + std::max(kRebuild_s, (steadyTime_s() - begin_s) / kRebuildPart);
    }
  }

  BattlefieldNow now() {
    const std::lock_guard<std::mutex> lock(mutex);
    std::vector<scenario::PlatformPose> present = platformPoses(*scenario, state->poses(steadyTime_s()));
    if (!poses || posed_scenario != scenario || hasMoved(*poses, present))
      poses = std::make_shared<const std::vector<scenario::PlatformPose>>(std::move(present));
    posed_scenario = scenario;
    return {scenario->loaded.scenario, poses, last_s.value_or(0)};
  }

  StreamStatus status() const {
    const std::lock_guard<std::mutex> lock(mutex);
    const double time_s = steadyTime_s();
    const interop::LiveCounts& counts = state->counts();
    StreamStatus result;
    result.kind = request.kind;
    result.records = foreign + counts.records;
    result.bytes = bytes;
    result.bad = counts.bad;
    result.late = counts.late;
    result.duplicates = counts.duplicates;
    result.lost = static_cast<long long>(lost);
    result.forgotten = counts.forgotten;
    result.entities = state->objectCount();
    result.emitters = static_cast<std::size_t>(scenario->emitters);
    result.unmatched = scenario->unmatched;
    result.records_per_s = rate.perSecond(time_s, result.records);
    if (last_s) result.age_s = time_s - *last_s;
    const auto add = [&result](const std::string& text) {
      if (text.empty()) return;
      result.trouble += (result.trouble.empty() ? "" : "; ") + text;
    };
    add(connection_trouble);
    if (connection_trouble.empty() && result.age_s && *result.age_s > formatOf(request.kind).silence_s)
      add("the stream has stopped");
    if (time_s - lost_at_s < 5)
      add(fmt::format("it comes faster than it can be read, {} lost",
                      countText(result.lost, "datagram", "datagrams")));
    if (counts.bad > 0)
      add(fmt::format("{} cannot be read, the first: {}", countText(counts.bad, "record", "records"),
                      counts.first_bad));
    if (counts.forgotten > 0)
      add(fmt::format("more than {} objects or {} beams: {} forgotten", interop::LiveLimits::kObjects,
                      interop::LiveLimits::kBeams, counts.forgotten));
    add(build_trouble);
    if (recorder) add(recorder->failure());
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

void LiveBattlefield::setWake(std::function<void()> wake) {
  const std::lock_guard<std::mutex> lock(impl_->wake_mutex);
  impl_->wake = std::move(wake);
}

BattlefieldNow LiveBattlefield::now() {
  return impl_->now();
}
StreamStatus LiveBattlefield::status() const {
  return impl_->status();
}
std::string LiveBattlefield::file() const {
  return impl_->maker.file();
}
void LiveBattlefield::finishRecording() {
  const std::lock_guard<std::mutex> lock(impl_->mutex);
  if (impl_->recorder) impl_->recorder->finish();
}

}  // namespace emscape::playback
