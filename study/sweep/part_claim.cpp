#include "study/sweep/part_claim.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/stat.h>
#include <unistd.h>

#include <atomic>
#include <cerrno>
#include <chrono>
#include <cmath>
#include <fstream>
#include <sstream>
#include <system_error>

#include "base/files/whole_file.h"
#include "emscape/base/error.h"

namespace emscape::study {
namespace {

namespace fs = std::filesystem;

constexpr std::chrono::seconds kBetweenTouches{30};
/// A claim that is younger than this by this machine's clock is not compared with the clock of the file
/// system.
constexpr double kRecent_s = 60;

[[noreturn]] void fail(const fs::path& file) {
  throw Error(ErrorCode::other, {file.string(), 0, 0},
              "cannot write: " + std::generic_category().message(errno));
}

/// Content of a claim; empty: none, or not written yet.
std::string holderOf(const fs::path& file) {
  std::ifstream stream(file);
  std::ostringstream text;
  text.exceptions(std::ios::badbit);
  text << stream.rdbuf();
  return text.str();
}

/// "HOST PROCESS MACHINE", different for two claims of one process.
std::string ownName() {
  char host[256] = "?";
  ::gethostname(host, sizeof host - 1);
  static std::atomic<int> count{0};
  return fmt::format("host {}\nprocess {}\nmachine {}\nclaim {}\n", host, ::getpid(), machineName(), ++count);
}

/// True if the holder is a process of this machine that has ended.
bool hasEnded(const std::string& holder) {
  std::istringstream text(holder);
  std::string key, host, machine;
  long process = 0;
  if (!(text >> key >> host >> key >> process >> key >> machine)) return false;
  return machine == machineName() && !isRunning(process);
}

double changed_s(const struct stat& status) {
  return static_cast<double>(status.st_mtim.tv_sec) + 1e-9 * static_cast<double>(status.st_mtim.tv_nsec);
}

/// Time since a file was touched, by the clock of its file system: those of two machines may differ.
double age_s(const fs::path& file) {
  struct stat status {};
  if (::stat(file.c_str(), &status) != 0) return 0;
  const double by_own_clock_s =
      std::chrono::duration<double>(std::chrono::system_clock::now().time_since_epoch()).count() -
      changed_s(status);
  if (std::abs(by_own_clock_s) < kRecent_s) return by_own_clock_s;
  const fs::path probe = temporaryFor(file);
  const int descriptor = ::open(probe.c_str(), O_WRONLY | O_CREAT | O_CLOEXEC, 0666);
  if (descriptor < 0) fail(file);
  struct stat now {};
  const bool is_known = ::futimens(descriptor, nullptr) == 0 && ::fstat(descriptor, &now) == 0;
  ::close(descriptor);
  std::error_code ignored;
  fs::remove(probe, ignored);
  return is_known ? changed_s(now) - changed_s(status) : 0;
}

bool isAbandoned(const fs::path& file, const std::string& holder) {
  return hasEnded(holder) || age_s(file) > PartClaim::kAbandoned_s;
}

/// Removes an abandoned claim. Of several processes that try, one succeeds.
void removeAbandoned(const fs::path& file, const std::string& holder) {
  const fs::path taken = temporaryFor(file);
  if (::rename(file.c_str(), taken.c_str()) != 0) return;
  // Another process may have removed the claim and made its own: that one is restored, unless there is a
  // third.
  if (holderOf(taken) != holder) static_cast<void>(::link(taken.c_str(), file.c_str()) == 0);
  std::error_code ignored;
  fs::remove(taken, ignored);
}

}  // namespace

std::unique_ptr<PartClaim> PartClaim::tryClaim(const fs::path& file) {
  for (int attempt = 0; attempt < 2; ++attempt) {
    const int descriptor = ::open(file.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, 0666);
    if (descriptor >= 0) {
      const std::string holder = ownName();
      const bool is_written =
          ::write(descriptor, holder.data(), holder.size()) == static_cast<ssize_t>(holder.size()) &&
          ::fsync(descriptor) == 0;
      const int cause = errno;
      ::close(descriptor);
      if (is_written) return std::unique_ptr<PartClaim>(new PartClaim(file, holder));
      ::unlink(file.c_str());
      errno = cause;
      fail(file);
    }
    if (errno != EEXIST) fail(file);
    const std::string holder = holderOf(file);
    if (!isAbandoned(file, holder)) return nullptr;
    removeAbandoned(file, holder);
  }
  return nullptr;
}

bool PartClaim::isHeld(const fs::path& file) {
  return fs::exists(file) && !isAbandoned(file, holderOf(file));
}

PartClaim::PartClaim(fs::path file, std::string holder) : file_(std::move(file)), holder_(std::move(holder)) {
  thread_ = std::thread([this] { touchRegularly(); });
}

PartClaim::~PartClaim() {
  {
    const std::lock_guard<std::mutex> lock(mutex_);
    has_ended_ = true;
  }
  ended_.notify_all();
  thread_.join();
  std::error_code ignored;
  if (holderOf(file_) == holder_) fs::remove(file_, ignored);
}

void PartClaim::touchRegularly() {
  std::unique_lock<std::mutex> lock(mutex_);
  while (!ended_.wait_for(lock, kBetweenTouches, [this] { return has_ended_; })) {
    if (holderOf(file_) == holder_) static_cast<void>(::utimensat(AT_FDCWD, file_.c_str(), nullptr, 0) == 0);
  }
}

}  // namespace emscape::study
