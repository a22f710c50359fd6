// Scripts of the window.
#include "apps/view/session/script.h"
#include "tests/fuzz/fuzz_target.h"

namespace emscape::test {
namespace {

namespace fs = std::filesystem;

const FuzzTargetsAdded added({
    {"view_script", "input.jsonl",
     [](const fs::path& file, const std::string&) { view::Script script(file); },
     [] {
       return std::vector<std::string>{
           "# a tour\n{\"do\":\"wait_frame\"}\n{\"do\":\"seek\",\"time_s\":4,\"at_s\":1.5}\n"
           "{\"do\":\"key\",\"key\":\"Ctrl+Shift+Z\"}\n",
           "{\"do\":\"set\",\"path\":\"emitters.radar.power_w\",\"value\":\"500\"}\n{\"do\":\"quit\"}\n",
           "{\"do\":\"plane\",\"kind\":\"horizontal\",\"altitude_m\":500}\n"
           "{\"do\":\"wait_state\",\"state\":\"exact\",\"timeout_s\":30,\"must\":false}\n"
           "{\"do\":\"set_together\",\"edits\":[\"a.b=1\",\"c=2\"]}\n"};
     }},
});

}  // namespace
}  // namespace emscape::test
