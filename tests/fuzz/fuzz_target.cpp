#include "tests/fuzz/fuzz_target.h"

#include <algorithm>
#include <map>
#include <memory>
#include <set>
#include <sstream>
#include <stdexcept>

#include "emscape/base/error.h"
#include "tests/support/files.h"
#include "tests/support/temporary_folder.h"

namespace emscape::test {
namespace {

constexpr std::size_t kLongestLine = 1000;
constexpr std::size_t kDictionaryWords = 1000;

/// The input being read; messages may quote it.
const std::string* input = nullptr;

std::vector<FuzzTarget>& targets() {
  static std::vector<FuzzTarget> all;
  return all;
}

/// The working folder of a target, prepared.
const std::filesystem::path& workingFolder(const FuzzTarget& target) {
  static std::map<std::string, std::unique_ptr<TemporaryFolder>> folders;
  std::unique_ptr<TemporaryFolder>& folder = folders[target.name];
  if (!folder) {
    folder = std::make_unique<TemporaryFolder>();
    std::filesystem::create_directories((folder->path() / target.file).parent_path());
    if (target.prepare) target.prepare(folder->path());
  }
  return folder->path();
}

void addWords(const std::string& text, std::set<std::string>& words) {
  std::string word;
  for (const char c : text + " ") {
    if (std::isalnum(static_cast<unsigned char>(c)) != 0 || c == '_' || c == ':') {
      word += c;
      continue;
    }
    if (word.size() >= 3 && word.size() <= 40) words.insert(word);
    word.clear();
  }
}

}  // namespace

FuzzTargetsAdded::FuzzTargetsAdded(std::vector<FuzzTarget> added) {
  for (FuzzTarget& target : added) targets().push_back(std::move(target));
  std::sort(targets().begin(), targets().end(),
            [](const FuzzTarget& a, const FuzzTarget& b) { return a.name < b.name; });
}

const std::vector<FuzzTarget>& fuzzTargets() {
  return targets();
}

const FuzzTarget& fuzzTarget(const std::string& name) {
  std::string names;
  for (const FuzzTarget& target : targets()) {
    if (target.name == name) return target;
    names += (names.empty() ? "" : ", ") + target.name;
  }
  throw std::invalid_argument("'" + name + "' must be one of the targets: " + names);
}

void checkFuzzMessage(const std::string& message) {
  // Once an input has held such words, any later message may quote them: archives' lists are cached by GDAL.
  static std::set<std::string> quoted;
  for (const char* foreign : {"json.exception", "std::bad_alloc", "std::exception", "yaml-cpp"}) {
    if (input != nullptr && input->find(foreign) != std::string::npos) quoted.insert(foreign);
    if (quoted.count(foreign) == 0 && message.find(foreign) != std::string::npos)
      throw std::logic_error("a message in the words of a library: " + message);
  }
  std::istringstream lines(message);
  for (std::string line; std::getline(lines, line);) {
    if (line.size() > kLongestLine)
      throw std::logic_error("a message of " + std::to_string(line.size()) + " characters: " + line);
    if (std::any_of(line.begin(), line.end(), [](unsigned char c) { return c < 0x20 || c == 0x7f; }))
      throw std::logic_error("a message with control characters: " + line);
  }
}

void runFuzzInput(const FuzzTarget& target, const std::string& bytes) {
  std::filesystem::path file;
  if (!target.file.empty()) {
    file = workingFolder(target) / target.file;
    writeFile(file, bytes);
  }
  input = &bytes;
  try {
    target.read(file, bytes);
  } catch (const Error& error) {
    checkFuzzMessage(error.what());
  }
}

void copyScenarios(const std::filesystem::path& folder) {
  using Options = std::filesystem::copy_options;
  std::filesystem::copy(sourceFile("scenarios"), folder, Options::recursive | Options::overwrite_existing);
}

std::string fuzzDictionary(const FuzzTarget& target) {
  std::set<std::string> words;
  if (target.vocabulary) addWords(target.vocabulary(), words);
  for (const std::string& seed : target.seeds()) addWords(seed, words);
  std::string text;
  std::size_t count = 0;
  for (const std::string& word : words) {
    if (++count > kDictionaryWords) break;
    text += '"' + word + "\"\n";
  }
  return text;
}

}  // namespace emscape::test
