#include "study/sweep/results/part_processes.h"

#include <fcntl.h>
#include <fmt/core.h>
#include <poll.h>
#include <signal.h>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstdlib>
#include <deque>
#include <map>
#include <memory>
#include <system_error>

#include "base/control_group.h"
#include "emscape/base/error.h"
#include "emscape/base/log.h"
#include "emscape/base/parallel.h"

extern char** environ;

namespace emscape::study {
namespace {

/// Number of times that a process may die in a part without finishing a variant, before the part is taken as
/// the cause.
constexpr int kMaxDeaths = 5;
constexpr int kPoll_ms = 200;

[[noreturn]] void failStarting(int cause) {
  throw Error(
      ErrorCode::other,
      "a process for a part cannot be started: " + std::generic_category().message(cause) +
          (cause == EAGAIN                      ? " (ulimit -u, or a limit of a container)"
           : cause == EMFILE || cause == ENFILE ? " (ulimit -n)"
                                                : "") +
          (cause == ENOENT ? ": /proc/self/exe; --jobs 1 needs no /proc" : "; fewer --jobs need less"));
}

/// A process that computes parts one after another.
class Worker {
 public:
  explicit Worker(const std::vector<std::string>& command) {
    int to_child[2], from_child[2];
    if (pipe2(to_child, O_CLOEXEC) != 0) failStarting(errno);
    if (pipe2(from_child, O_CLOEXEC) != 0) failStarting(errno);
    posix_spawn_file_actions_t actions;
    posix_spawn_file_actions_init(&actions);
    posix_spawn_file_actions_adddup2(&actions, to_child[0], STDIN_FILENO);
    posix_spawn_file_actions_adddup2(&actions, from_child[1], STDOUT_FILENO);
    std::vector<char*> argv;
    for (const std::string& word : command) argv.push_back(const_cast<char*>(word.c_str()));
    argv.push_back(nullptr);
    const int failure = posix_spawn(&process_, argv.front(), &actions, nullptr, argv.data(), environ);
    posix_spawn_file_actions_destroy(&actions);
    close(to_child[0]);
    close(from_child[1]);
    to_ = to_child[1];
    from_ = from_child[0];
    if (failure != 0) failStarting(failure);
  }
  Worker(const Worker&) = delete;
  Worker& operator=(const Worker&) = delete;
  ~Worker() {
    stop();
    if (process_ > 0) finish();
    close(from_);
  }

  void stop() const {
    if (process_ > 0) kill(process_, SIGTERM);
  }

  int descriptor() const { return from_; }
  int part() const { return part_; }

  void compute(int part) {
    part_ = part;
    const std::string line = fmt::format("{}\n", part);
    // An ended process is detected by the end of its output.
    static_cast<void>(!write(to_, line.data(), line.size()));
  }

  /// Reads the output of the process.
  /// @return 1: its part is complete; 0: not yet; -1: its output has ended
  int read() {
    char bytes[256];
    const ssize_t count = ::read(from_, bytes, sizeof bytes);
    if (count < 0 && errno == EINTR) return 0;
    if (count <= 0) return -1;
    return std::find(bytes, bytes + count, '\n') != bytes + count ? 1 : 0;
  }

  /// Ends the process, which must have no part to compute. @return its status, as of waitpid()
  int finish() {
    if (to_ >= 0) close(to_);
    to_ = -1;
    int status = 0;
    while (waitpid(process_, &status, 0) < 0 && errno == EINTR) {
    }
    process_ = -1;
    return status;
  }

 private:
  pid_t process_ = -1;
  int to_ = -1, from_ = -1;
  int part_ = 0;
};

/// Processes that compute at the same time; an empty one has ended.
struct Workers : std::vector<std::unique_ptr<Worker>> {
  using vector::vector;
  Workers(const Workers&) = delete;
  Workers& operator=(const Workers&) = delete;
  /// Stops all before the first is waited for.
  ~Workers() {
    for (const auto& worker : *this) {
      if (worker) worker->stop();
    }
  }
};

/// The remaining parts, in one contiguous range per worker, so that a worker computes successive parts.
class Stretches {
 public:
  Stretches(const std::vector<int>& parts, std::size_t count) {
    for (std::size_t s = 0; s < count; ++s) {
      const auto begin = parts.begin() + static_cast<std::ptrdiff_t>(parts.size() * s / count);
      const auto end = parts.begin() + static_cast<std::ptrdiff_t>(parts.size() * (s + 1) / count);
      stretches_.emplace_back(begin, end);
    }
  }

  /// The next part of a worker: from its own range, or from the end of the longest one; 0: none is left.
  int next(std::size_t worker) {
    std::deque<int>& own = stretches_[worker];
    if (!own.empty()) {
      const int part = own.front();
      own.pop_front();
      return part;
    }
    const auto longest = std::max_element(stretches_.begin(), stretches_.end(),
                                          [](const auto& a, const auto& b) { return a.size() < b.size(); });
    if (longest->empty()) return 0;
    // Takes half of it, so that the parts taken are successive, too.
    const auto half = longest->end() - static_cast<std::ptrdiff_t>((longest->size() + 1) / 2);
    own.assign(half, longest->end());
    longest->erase(half, longest->end());
    return next(worker);
  }

 private:
  std::vector<std::deque<int>> stretches_;
};

}  // namespace

void computeInProcesses(const std::vector<int>& parts, int jobs, const std::vector<std::string>& command,
                        const std::function<std::uintmax_t(int)>& finishedBytes,
                        const ProgressSink& progress) {
  const std::size_t count = std::min(static_cast<std::size_t>(jobs), parts.size());
  Stretches left(parts, count);
  Workers workers(count);
  struct Deaths {
    int count = 0;
    std::uintmax_t finished_bytes = 0;  ///< at the last death
  };
  std::map<int, Deaths> deaths;
  std::size_t done = 0;
  const auto showProgress = [&] {
    progress("variants", static_cast<double>(done) / static_cast<double>(parts.size()));
  };
  const auto start = [&](std::size_t w, int part) {
    workers[w] = std::make_unique<Worker>(command);
    workers[w]->compute(part);
  };
  for (std::size_t w = 0; w < count; ++w) start(w, left.next(w));
  while (done < parts.size()) {
    showProgress();
    std::vector<pollfd> polled;
    std::vector<std::size_t> which;
    for (std::size_t w = 0; w < count; ++w) {
      if (!workers[w]) continue;
      polled.push_back({workers[w]->descriptor(), POLLIN, 0});
      which.push_back(w);
    }
    if (poll(polled.data(), polled.size(), kPoll_ms) <= 0) continue;
    for (std::size_t i = 0; i < polled.size(); ++i) {
      if (polled[i].revents == 0) continue;
      Worker& worker = *workers[which[i]];
      const int read = worker.read();
      if (read == 0) continue;
      if (read > 0) {
        ++done;
        if (const int part = left.next(which[i]); part > 0) {
          worker.compute(part);
        } else {
          worker.finish();
          workers[which[i]].reset();
        }
        continue;
      }
      const int part = worker.part(), status = worker.finish();
      workers[which[i]].reset();
      showProgress();  // ends the work if this process was told to stop, too
      if (!WIFSIGNALED(status)) {
        const int code = WIFEXITED(status) && WEXITSTATUS(status) > 0 && WEXITSTATUS(status) < 6
                             ? WEXITSTATUS(status)
                             : static_cast<int>(ErrorCode::other);
        if (WIFEXITED(status) && WEXITSTATUS(status) > 128) {
          throw Error(ErrorCode::other, fmt::format("the process of part {} was stopped by signal {}", part,
                                                    WEXITSTATUS(status) - 128));
        }
        throw Error(static_cast<ErrorCode>(code),
                    fmt::format("the process of part {} failed; its message stands above", part));
      }
      Deaths& of_part = deaths[part];
      const std::uintmax_t finished_bytes = finishedBytes(part);
      if (finished_bytes > of_part.finished_bytes) of_part = {0, finished_bytes};
      if (++of_part.count == kMaxDeaths) {
        throw Error(ErrorCode::other, fmt::format("part {} ended its process {} times, the last by signal {}",
                                                  part, kMaxDeaths, WTERMSIG(status)));
      }
      logWarning(fmt::format("the process of part {} was ended by signal {}; another one goes on with it",
                             part, WTERMSIG(status)));
      start(which[i], part);
    }
  }
  progress("variants", 1);
}

int allowedProcessors() {
  int allowed = threadCount();
  if (const char* const text = std::getenv("SLURM_CPUS_PER_TASK")) {
    const int of_task = std::atoi(text);
    if (of_task > 0) allowed = std::min(allowed, of_task);
  }
  if (const std::optional<double> processors = ControlGroups().processors())
    allowed = std::min(allowed, std::max(1, static_cast<int>(*processors + 0.5)));
  return allowed;
}

}  // namespace emscape::study
