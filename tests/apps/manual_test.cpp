// Manual pages and shell completion against --help; licences against the libraries to which the programs are
// linked.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cstdio>
#include <filesystem>
#include <memory>
#include <nlohmann/json.hpp>
#include <regex>
#include <set>
#include <sstream>

#include "tests/apps/program.h"

namespace emscape::test {
namespace {

using nlohmann::json;
using testing::AnyOf;
using testing::Each;
using testing::HasSubstr;
using testing::Not;
using testing::StartsWith;

std::string shareFile(const std::string& name) {
  const std::string file = besideThisProgram("../share/" + name);
  const std::string text = readFile(file);
  EXPECT_FALSE(text.empty()) << file;
  return text;
}

/// Standard output of a shell command.
std::string outputOf(const std::string& command) {
  const std::unique_ptr<FILE, int (*)(FILE*)> pipe(popen(command.c_str(), "r"), pclose);
  std::string text;
  char buffer[4096];
  for (std::size_t count; (count = std::fread(buffer, 1, sizeof(buffer), pipe.get())) > 0;)
    text.append(buffer, count);
  return text;
}

bool hasWindow() {
  return std::filesystem::exists(besideThisProgram("emscape-view"));
}

/// The contents of a command's --help: names of options, and subcommands.
struct Help {
  std::vector<std::string> options, subcommands;
};

Help helpOf(Arguments command) {
  command.emplace_back("--help");
  const ProgramResult result = runWell(command);
  Help help;
  std::istringstream lines(result.out);
  std::string section;
  for (std::string line; std::getline(lines, line);) {
    if (line.empty() || line.front() != ' ') section = line;
    std::smatch found;
    if (section == "Subcommands:" && std::regex_search(line, found, std::regex("^  ([a-z]+)"))) {
      if (found[1] != "view" || hasWindow()) help.subcommands.push_back(found[1]);
    } else if (section == "Options:" && std::regex_search(line, found, std::regex("^  (-[^ ]+)"))) {
      std::istringstream names(std::regex_replace(found[1].str(), std::regex("\\{[^}]*\\}"), ""));
      for (std::string name; std::getline(names, name, ',');) help.options.push_back(name);
    }
  }
  return help;
}

/// The text between two others; empty if it is not there.
std::string between(const std::string& text, const std::string& begin, const std::string& end) {
  const std::size_t at = text.find(begin);
  if (at == std::string::npos) return {};
  return text.substr(at, text.find(end, at + begin.size()) - at);
}

/// @param command  subcommands; empty: the program itself
/// @return the number of options
int expectDescribed(const Arguments& command) {
  static const std::string bash = shareFile("completion/emscape"), zsh = shareFile("completion/_emscape");
  std::string path = "emscape", function = "_emscape";
  for (const std::string& word : command) {
    path += " " + word;
    function += "_" + word;
  }
  std::string page = shareFile("man/emscape" + (command.empty() ? "" : "-" + command.front()) + ".1");
  if (command.size() == 2) page = between(page, "\\fB" + path + "\\fR [", ".SH");
  const std::string of_bash = between(bash, "    '" + path + "') words='", "\n");
  const std::string of_zsh = between(zsh, "\n" + function + "() {\n", "\n}\n");
  const Help help = helpOf(command);
  for (const std::string& option : help.options) {
    const std::string in_page = "\\fB" + std::regex_replace(option, std::regex("-"), "\\-") + "\\fR";
    EXPECT_THAT(page, HasSubstr(in_page)) << path;
    EXPECT_TRUE(std::regex_search(of_bash, std::regex("[' ]" + option + "[' ]"))) << path << " " << option;
    EXPECT_TRUE(std::regex_search(of_zsh, std::regex("[ '{,(]" + option + "['},)\\[]")))
        << path << " " << option;
  }
  int count = static_cast<int>(help.options.size());
  for (const std::string& subcommand : help.subcommands) {
    EXPECT_THAT(of_zsh, HasSubstr("\n        '" + subcommand + ":")) << path;
    EXPECT_TRUE(std::regex_search(between(bash, "'" + path + ":subcommands'", "\n"),
                                  std::regex("[' ]" + subcommand + "[' ]")))
        << path << " " << subcommand;
    Arguments inner = command;
    inner.push_back(subcommand);
    count += expectDescribed(inner);
  }
  return count;
}

TEST(Manual, SLOW_PagesAndCompletionHaveEveryOptionOfHelp) {
  EXPECT_GT(expectDescribed({}), 200);
}

/// Bash's completions for the last word.
std::string completed(const std::string& words) {
  return outputOf(
      "bash -c 'source \"$0\"; COMP_WORDS=(\"$@\"); COMP_CWORD=$(($# - 1)); _emscape; echo -n "
      "\"${COMPREPLY[@]}\"' " +
      besideThisProgram("../share/completion/emscape") + " " + words);
}

TEST(Completion, OfBashOffersSubcommandsOptionsAndChoices) {
  EXPECT_EQ(completed("emscape sim"), "simulate");
  EXPECT_EQ(completed("emscape simulate --form"), "--format");
  EXPECT_EQ(completed("emscape simulate --bac"), "--backend") << "global options may follow";
  EXPECT_EQ(completed("emscape simulate s.yaml --backend c"), "cpu cuda");
  EXPECT_EQ(completed("emscape --backend = cu"), "cuda");
  EXPECT_EQ(completed("emscape --backend cuda bench f"), "field");
  EXPECT_EQ(completed("emscape bench field --emi"), "--emitters");
  EXPECT_EQ(completed("emscape simulate --threads ''"), "");
  EXPECT_EQ(completed("emscape simulate ''"), "") << "a file is wanted";
  EXPECT_EQ(completed("emscape study --wor"), "") << "hidden options are not offered";
}

/// File names of the libraries that a program or library is linked with: "libtbb.so.12".
std::vector<std::string> librariesOf(const std::string& program) {
  const std::string text = outputOf("readelf --dynamic --wide " + besideThisProgram(program));
  std::vector<std::string> names;
  const std::regex needed("\\(NEEDED\\).*\\[(.*)\\]");
  for (std::sregex_iterator found(text.begin(), text.end(), needed); found != std::sregex_iterator(); ++found)
    names.push_back((*found)[1]);
  return names;
}

TEST(Licences, NameEveryLibraryThatTheProgramsLoadAndNoOther) {
  const json bill = json::parse(run({"--licences", "--json"}).out);
  const std::string text = run({"--licences"}).out;
  std::set<std::string> listed;
  for (const json& component : bill["components"]) {
    const std::string name = component["name"];
    EXPECT_THAT(text, HasSubstr("\n  " + name + " "));
    EXPECT_NE(component["version"], "") << name;
    std::string library, linkage;
    for (const json& property : component["properties"]) {
      (property["name"] == "emscape:library" ? library : linkage) = property["value"];
    }
    if (linkage == "shared library") listed.insert(library);
  }
  std::vector<std::string> loaded = librariesOf("emscape");
  ASSERT_FALSE(loaded.empty());
  EXPECT_THAT(loaded, Each(Not(AnyOf(StartsWith("libgdal"), StartsWith("libopenvdb")))))
      << "they are loaded when first needed";
  const std::vector<std::string> of_vdb = librariesOf("../lib/emscape/emscape_vdb.so");
  loaded.insert(loaded.end(), of_vdb.begin(), of_vdb.end());
  loaded.push_back("libgdal.so");
  if (hasWindow()) {
    const std::vector<std::string> of_window = librariesOf("emscape-view");
    loaded.insert(loaded.end(), of_window.begin(), of_window.end());
  }
  std::set<std::string> seen;
  for (const std::string& file : loaded) {
    // Parts of the C library, libraries of the sanitizers, and those that headers of OpenVDB and Pango need
    // without optimisation.
    if (std::regex_match(file, std::regex("ld-linux.*|lib(m|dl|pthread|rt|asan|ubsan|tsan|boost_iostreams|"
                                          "glib-2\\.0|harfbuzz)\\.so.*")))
      continue;
    const auto component = std::find_if(listed.begin(), listed.end(), [&](const std::string& library) {
      return file.rfind(library + ".", 0) == 0 || file.rfind(library + "-", 0) == 0;
    });
    ASSERT_NE(component, listed.end()) << file << " is not in cmake/EmscapeComponents.cmake";
    seen.insert(*component);
  }
  EXPECT_EQ(seen, listed) << "the programs do not load some of cmake/EmscapeComponents.cmake";
}

TEST(Licences, AreABillOfMaterialsWithoutATime) {
  const json bill = json::parse(run({"--licences", "--json"}).out);
  EXPECT_EQ(bill["bomFormat"], "CycloneDX");
  EXPECT_EQ(bill["metadata"]["component"]["name"], "emscape");
  EXPECT_FALSE(bill["metadata"].contains("timestamp"));
  EXPECT_EQ(bill["dependencies"][0]["dependsOn"].size(), bill["components"].size());
  EXPECT_EQ(bill, json::parse(shareFile("emscape.cdx.json")));
}

TEST(Version, DescribesTheBuild) {
  EXPECT_THAT(run({"--version"}).out,
              testing::MatchesRegex(
                  "emscape [0-9]+\\.[0-9]+\\.[0-9]+\nBuild: [^\n]+\nInstruction sets: [^\n]+\nGPU: .*\n"));
}

}  // namespace
}  // namespace emscape::test
