/// emscape play: streams a scenario or a recording to other programs.
#include <fmt/core.h>

#include <algorithm>
#include <chrono>
#include <memory>
#include <optional>
#include <thread>

#include "apps/common/console.h"
#include "apps/common/interrupt.h"
#include "apps/emscape/subcommands.h"
#include "base/text/count_text.h"
#include "emscape/base/error.h"
#include "emscape/base/work.h"
#include "emscape/scenario/file/scenario_file.h"
#include "interop/exporting/writers.h"
#include "playback/sockets/socket.h"
#include "playback/stream/acmi_server.h"
#include "recording/acmi/acmi_lines.h"
#include "recording/acmi/acmi_text.h"
#include "recording/common/byte_source.h"
#include "recording/cot/cot_event.h"
#include "recording/dis/datagrams.h"
#include "recording/read_recording.h"

namespace emscape::app {
namespace {

using Wait = std::function<void(double seconds)>;

struct PlayArguments {
  std::string input, dis_out, acmi_server, cot_out, interface, password;
  std::vector<scenario::Edit> edits;
  double rate = 1, step_s = 1;
  int ttl = 0;
};

/// Time of the scenario or the recording, at a rate.
class Pace {
 public:
  /// @param wait  for at most so long; does other work meanwhile
  Pace(double rate, Wait wait) : rate_(rate), wait_(std::move(wait)) {}

  /// Waits until it is t_s, counted from the first call's. @throws Stopped by the user
  void waitFor(double t_s) {
    if (!has_begun_) {
      has_begun_ = true;
      first_s_ = t_s;
      begin_ = Clock::now();
    }
    for (;;) {
      stopIfInterrupted();
      const std::chrono::duration<double> past = Clock::now() - begin_;
      const double left_s = (t_s - first_s_) / rate_ - past.count();
      if (left_s <= 0) return;
      wait_(std::min(left_s, 0.05));
    }
  }

 private:
  using Clock = std::chrono::steady_clock;
  double rate_;
  Wait wait_;
  bool has_begun_ = false;
  double first_s_ = 0;
  Clock::time_point begin_;
};

bool endsWith(const std::string& text, const std::string& end) {
  return text.size() > end.size() && text.compare(text.size() - end.size(), end.size(), end) == 0;
}

/// A scenario with its terrain, as the writers take it.
struct Played {
  std::shared_ptr<const scenario::Scenario> scenario;
  scenario::TerrainPtr terrain;

  explicit Played(const PlayArguments& arguments)
      : scenario(scenario::loadScenario(arguments.input, arguments.edits, scenario::ReadFor::chosen_times)),
        terrain(scenario::loadTerrain(*scenario)) {
    interop::requireFewRecords(*scenario, arguments.step_s);
  }
};

/// @throws Error (usage) for options of multicast with another address
void checkMulticast(const PlayArguments& arguments, const playback::Address& address) {
  if (!arguments.interface.empty()) playback::requireMulticast(address, "--interface");
  if (arguments.ttl > 0) playback::requireMulticast(address, "--ttl");
}

/// Sends datagrams at their times.
class PacedSender {
 public:
  PacedSender(const PlayArguments& arguments, const std::string& to, const char* option)
      : address_(playback::parseAddress(to, option)),
        sender_(address_,
                playback::parseHost(arguments.interface.empty() ? playback::kLoopback : arguments.interface,
                                    "--interface"),
                arguments.ttl),
        pace_(arguments.rate,
              [](double seconds) { std::this_thread::sleep_for(std::chrono::duration<double>(seconds)); }) {
    checkMulticast(arguments, address_);
  }

  void waitFor(double t_s) { pace_.waitFor(t_s); }
  void send(const void* bytes, std::size_t size) {
    (sender_.send(static_cast<const std::uint8_t*>(bytes), size) ? sent_ : refused_) += 1;
  }
  void tell(const GlobalOptions& global) const {
    if (global.json) {
      printJson({{"to", address_.text()}, {"sent", sent_}, {"refused", refused_}});
    } else if (!global.quiet) {
      print("{} sent to {}{}\n", countText(sent_, "datagram", "datagrams"), address_.text(),
            refused_ > 0 ? fmt::format("; {} were refused by the system", refused_) : "");
    }
  }

 private:
  playback::Address address_;
  playback::DatagramSender sender_;
  Pace pace_;
  long long sent_ = 0, refused_ = 0;
};

/// Events happen now: receivers drop those whose stale time is past.
int playCot(const PlayArguments& arguments, const GlobalOptions& global) {
  PacedSender sender(arguments, arguments.cot_out, "--cot-out");
  long long bad = 0;
  interop::CotSplitter splitter;
  const auto take = [&](std::string_view text) {
    splitter.take(text, [&](std::string_view xml) {
      std::string fault;
      const auto event = interop::parseCotEvent(xml, fault);
      if (!event) {
        ++bad;
        return;
      }
      sender.waitFor(event->time_s);
      const double now_s =
          std::chrono::duration<double>(std::chrono::system_clock::now().time_since_epoch()).count();
      const std::string stamped =
          interop::restampedCotEvent(xml, now_s, (event->stale_s - event->time_s) / arguments.rate);
      sender.send(stamped.data(), stamped.size());
    });
  };
  if (endsWith(arguments.input, ".cot")) {
    const auto source = interop::openRecording(arguments.input);
    std::vector<char> piece(std::size_t{1} << 16);
    while (const std::size_t count = source->read(piece.data(), piece.size())) take({piece.data(), count});
  } else {
    const Played played(arguments);
    std::vector<interop::ExportedRow> rows;
    interop::writeCot({*played.scenario, played.terrain.get(), arguments.step_s, {}}, take, rows);
  }
  if (bad > 0) {
    printMessage("emscape: {}: {} not sent\n", arguments.input,
                 countText(bad, "event that cannot be read is", "events that cannot be read are"));
  }
  sender.tell(global);
  return 0;
}

int playDis(const PlayArguments& arguments, const GlobalOptions& global) {
  PacedSender sender(arguments, arguments.dis_out, "--dis-out");
  const auto send = [&](double t_s, const std::uint8_t* bytes, std::size_t size) {
    sender.waitFor(t_s);
    sender.send(bytes, size);
  };
  if (endsWith(arguments.input, ".pcap") || endsWith(arguments.input, ".pcapng")) {
    const auto source = interop::openFile(arguments.input);
    interop::ReadingTally tally;
    interop::dis::readCapture(*source, tally, [&](const interop::dis::Datagram& datagram) {
      send(datagram.arrival_s, datagram.bytes, datagram.size);
    });
    if (!tally.torn.empty()) printMessage("emscape: {}: {}\n", arguments.input, tally.torn);
  } else {
    const Played played(arguments);
    std::vector<interop::ExportedRow> rows;
    interop::writeDis(
        {*played.scenario, played.terrain.get(), arguments.step_s, {}},
        [&](double t_s, const std::vector<std::uint8_t>& bytes) { send(t_s, bytes.data(), bytes.size()); },
        rows);
  }
  sender.tell(global);
  return 0;
}

int playAcmi(const PlayArguments& arguments, const GlobalOptions& global) {
  const playback::Address address = playback::parseAddress(arguments.acmi_server, "--acmi-server");
  if (address.isMulticast())
    throw Error(ErrorCode::usage, "--acmi-server " + arguments.acmi_server + ": TCP has no multicast groups");
  checkMulticast(arguments, address);
  // What is wrong is told before a client is waited for.
  std::optional<Played> played;
  std::unique_ptr<interop::ByteSource> source;
  if (endsWith(arguments.input, ".acmi"))
    source = interop::openRecording(arguments.input);
  else
    played.emplace(arguments);
  playback::AcmiServer server(address, arguments.password);
  const auto serve = [&](double seconds) {
    server.serve(seconds);
    for (const std::string& event : server.takeEvents()) {
      if (!global.quiet) printMessage("emscape: {}\n", event);
    }
  };
  if (!global.quiet) printMessage("emscape: waiting for a client at {}\n", address.text());
  while (server.clientCount() == 0) {
    stopIfInterrupted();
    serve(0.05);
  }
  Pace pace(arguments.rate, serve);
  long long lines = 0;
  interop::AcmiLines logical_lines;
  const auto send = [&](std::string_view physical, bool is_cut) {
    const auto line = logical_lines.take(physical, is_cut);
    if (!line) return;
    // Frames out of order are sent at once.
    if (const auto time_s = interop::acmiFrame_s(*line)) pace.waitFor(*time_s);
    server.send(*line);
    if (++lines % 256 == 0) serve(0);
  };
  if (source) {
    interop::LineReader reader(*source);
    for (std::string_view line; reader.next(line);) send(line, reader.isCut());
  } else {
    std::vector<interop::ExportedRow> rows;
    interop::writeAcmi(
        {*played->scenario, played->terrain.get(), arguments.step_s, {}},
        [&](const std::string& piece) {
          std::string_view rest = piece;
          while (!rest.empty()) {
            const std::size_t end = rest.find('\n');
            send(rest.substr(0, end), false);
            rest.remove_prefix(std::min(end == std::string_view::npos ? rest.size() : end + 1, rest.size()));
          }
        },
        rows);
  }
  serve(0.5);
  if (logical_lines.tooLong() > 0)
    printMessage("emscape: {}: {} not sent: longer than 1 MiB\n", arguments.input,
                 countText(logical_lines.tooLong(), "line was", "lines were"));
  if (global.json) {
    printJson({{"at", address.text()}, {"lines", lines}, {"clients", server.clientCount()}});
  } else if (!global.quiet) {
    print("{} sent at {} to {}\n", countText(lines, "line", "lines"), address.text(),
          countText(server.clientCount(), "client", "clients"));
  }
  return 0;
}

int play(const PlayArguments& arguments, const GlobalOptions& global) {
  const bool is_dis = !arguments.dis_out.empty(), is_server = !arguments.acmi_server.empty(),
             is_tak = !arguments.cot_out.empty();
  if (is_dis + is_server + is_tak != 1) {
    throw Error(ErrorCode::usage,
                "expected one of --dis-out, --acmi-server and --cot-out with [HOST:]PORT, such as --dis-out "
                "127.0.0.1:3000");
  }
  const bool is_capture = endsWith(arguments.input, ".pcap") || endsWith(arguments.input, ".pcapng");
  const bool is_acmi = endsWith(arguments.input, ".acmi"), is_cot = endsWith(arguments.input, ".cot");
  if ((is_capture && !is_dis) || (is_acmi && !is_server) || (is_cot && !is_tak)) {
    throw Error(
        ErrorCode::usage,
        fmt::format("{}: a recording is played in its own format; `emscape import` makes a scenario of "
                    "it, which is played in any",
                    arguments.input));
  }
  if ((is_capture || is_acmi || is_cot) && !arguments.edits.empty())
    throw Error(ErrorCode::usage, "--set changes a scenario, not a recording");
  if (is_tak) return playCot(arguments, global);
  return is_dis ? playDis(arguments, global) : playAcmi(arguments, global);
}

}  // namespace

void addPlay(CLI::App& app, const GlobalOptions& global, Action& action) {
  CLI::App* command = app.add_subcommand("play", "Stream a scenario or a recording to other programs");
  command->fallthrough();
  command->footer(R"(
Sends DIS version 7 or Cursor on Target (TAK) by UDP, or is a host of Tacview's real-time telemetry by TCP, which waits for its
first client. Recordings (.pcap, .pcapng; .acmi, .zip.acmi; .cot) are sent as they are, events of .cot with the present time. Sends to and listens on this computer alone unless an address is given.

Examples:
  emscape play scenarios/jamming.yaml --dis-out 127.0.0.1:3000
  emscape play exercise.pcap --dis-out 239.1.2.3:3000 --rate 10
  emscape play scenarios/jamming.yaml --acmi-server 42674
  emscape play team.cot --cot-out 239.2.3.1:6969 --interface 10.0.0.5 --ttl 1

Exit status: 0; 2 for wrong options; 3 for a faulty scenario or recording; 1 if the address cannot be used; 128 + N stopped by
signal N (130 after Ctrl-C).)");
  auto arguments = std::make_shared<PlayArguments>();
  command
      ->add_option("INPUT", arguments->input,
                   "Scenario, or recording: .pcap, .pcapng, .acmi, .zip.acmi, .cot")
      ->required();
  addSetOption(*command, arguments->edits);
  command->add_option("--dis-out", arguments->dis_out,
                      "[HOST:]PORT: send DIS by UDP to a host or multicast group (127.0.0.1)");
  command->add_option("--acmi-server", arguments->acmi_server,
                      "[HOST:]PORT: serve ACMI by TCP at an address of this computer (127.0.0.1)");
  command->add_option("--cot-out", arguments->cot_out,
                      "[HOST:]PORT: send Cursor on Target by UDP to a host or multicast group (127.0.0.1)");
  command->add_option("--rate", arguments->rate, "Times real time")->check(CLI::Range(1e-3, 1e6));
  command
      ->add_option("--step", arguments->step_s,
                   "Largest time between positions of a moving platform of a scenario (s)")
      ->check(CLI::Range(0.01, 3600.0));
  command->add_option("--ttl", arguments->ttl, "Hops of multicast; 0: it stays on this computer")
      ->check(CLI::Range(0, 255));
  command->add_option("--interface", arguments->interface,
                      "Address of the interface from which multicast is sent (127.0.0.1)");
  command->add_option("--password", arguments->password, "Password that clients of ACMI must give");
  command->callback(
      [arguments, &global, &action] { action = [arguments, &global] { return play(*arguments, global); }; });
}

}  // namespace emscape::app
