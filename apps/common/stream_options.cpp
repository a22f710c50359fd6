#include "apps/common/stream_options.h"

#include <fmt/core.h>

#include "apps/common/interrupt.h"
#include "emscape/base/error.h"

namespace emscape::app {

void StreamOptions::addTo(CLI::App& command, const std::string& base, const std::string& database) {
  CLI::Option* const of_dis = command.add_option(
      "--dis", dis,
      "[HOST:]PORT: listen for DIS by UDP; HOST is an address of this computer or a multicast group "
      "(127.0.0.1)");
  CLI::Option* const of_acmi = command.add_option(
      "--acmi", acmi, "[HOST:]PORT: connect to a host of Tacview's real-time telemetry by TCP (127.0.0.1)");
  of_acmi->excludes(of_dis);
  command
      .add_option("--cot", cot,
                  "[HOST:]PORT: listen for Cursor on Target (TAK) by UDP; HOST as of --dis. "
                  "tcp:[HOST:]PORT: connect to a TAK server (127.0.0.1)")
      ->excludes(of_dis)
      ->excludes(of_acmi);
  command.add_option("--interface", interface,
                     "Address of the interface on which a multicast group is joined (127.0.0.1)");
  command.add_option("--password", request.password, "Password of the ACMI host");
  if (!base.empty()) {
    command.add_option(base, request.base,
                       "Scenario with region and terrain, to which the objects of the stream are added");
  }
  command.add_option(database, request.emitters,
                     "Emitter database, whose rows come before the starter set's");
  command.add_option("--record", request.record,
                     "Record what arrives: .pcap of DIS, .acmi of ACMI, .cot of Cursor on Target");
  command.add_flag("--force", request.replaces, "Replace files of --record and --output that exist");
  command
      .add_option_function<double>(
          "--timeout",
          [this](double seconds) {
            request.read.emission_timeout_s = seconds;
            request.read.entity_timeout_s = seconds / 2;
          },
          "Seconds without update after which an emission of DIS ends; an entity after half of it (24)")
      ->check(CLI::Range(0.2, 1e6));
}

playback::StreamRequest StreamOptions::parse() const {
  if (!isGiven()) {
    throw Error(ErrorCode::usage,
                "a stream is needed: --dis [HOST:]PORT, --acmi [HOST:]PORT or --cot [HOST:]PORT, such as "
                "--dis 127.0.0.1:3000");
  }
  playback::StreamRequest parsed = request;
  parsed.stop = &stopFlag();
  constexpr std::string_view kTcp = "tcp:";
  const bool is_tcp = cot.compare(0, kTcp.size(), kTcp) == 0;
  std::string option = "--dis", address = dis;
  if (!acmi.empty()) {
    option = "--acmi";
    address = acmi;
    parsed.kind = playback::StreamKind::acmi;
  } else if (!cot.empty()) {
    option = "--cot";
    address = is_tcp ? cot.substr(kTcp.size()) : cot;
    parsed.kind = playback::StreamKind::cot;
  }
  parsed.connects = !acmi.empty() || is_tcp;
  parsed.address = playback::parseAddress(address, option);
  if (!interface.empty()) playback::requireMulticast(parsed.address, "--interface");
  parsed.interface = playback::parseHost(interface.empty() ? playback::kLoopback : interface, "--interface");
  if (parsed.connects && parsed.address.isMulticast())
    throw Error(ErrorCode::usage, fmt::format("{} {}: TCP has no multicast groups", option, address));
  return parsed;
}

}  // namespace emscape::app
