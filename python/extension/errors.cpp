/// Exceptions, messages, progress and forks.
#include <fmt/format.h>
#include <pthread.h>

#include <atomic>
#include <chrono>

#include "emscape/base/error.h"
#include "emscape/base/log.h"
#include "emscape/base/work.h"
#include "python/extension/module.h"

namespace emscape::python {
namespace {

constexpr std::chrono::milliseconds kInterval(100);  // between calls of a progress function

std::atomic<bool> is_used{false}, is_forked{false};

/// Raises the class of emscape._errors for an error of the libraries.
void raise(const Error& error) {
  try {
    const nb::object make = nb::module_::import_("emscape._errors").attr("make");
    const SourceLocation& location = error.location();
    const nb::object raised =
        make(static_cast<int>(error.code()), error.message(), location.file, location.line, location.column);
    PyErr_SetObject(reinterpret_cast<PyObject*>(Py_TYPE(raised.ptr())), raised.ptr());
  } catch (nb::python_error& failure) {
    failure.restore();
  }
}

}  // namespace

void refuseForkedProcess() {
  if (is_forked) {
    throw Error(
        ErrorCode::usage,
        "this process was forked from one that had used emscape, whose threads and GPU are lost in it; start "
        "processes with multiprocessing.get_context('spawn')");
  }
  is_used = true;
}

ProgressSink progressSink(const ProgressCall& call) {
  using Clock = std::chrono::steady_clock;
  struct Last {
    Clock::time_point time;
    std::string step;
  };
  // The function is released with the interpreter locked.
  const std::shared_ptr<nb::callable> function(call ? new nb::callable(*call) : nullptr,
                                               [](nb::callable* held) {
                                                 const nb::gil_scoped_acquire locked;
                                                 delete held;
                                               });
  return [function, last = std::make_shared<Last>()](const std::string& step, double fraction) {
    const Clock::time_point now = Clock::now();
    if (fraction < 1 && step == last->step && now - last->time < kInterval) return;
    *last = {now, step};
    const nb::gil_scoped_acquire locked;
    if (PyErr_CheckSignals() != 0) throw nb::python_error();
    if (function) (*function)(step, fraction);
  };
}

void requireWithin(const char* name, double value, double min, double max, const char* unit) {
  if (value >= min && value <= max) return;
  throw Error(ErrorCode::usage,
              fmt::format("{} is {}, outside the allowed range {} to {}{}", name, value, min, max, unit));
}

std::vector<scenario::Edit> editsOf(const Edits& edits) {
  std::vector<scenario::Edit> result;
  for (const auto& [path, value] : edits) result.push_back({path, value});
  return result;
}

void bindErrors(nb::module_& module) {
  nb::register_exception_translator([](const std::exception_ptr& thrown, void*) {
    try {
      std::rethrow_exception(thrown);
    } catch (const Error& error) {
      raise(error);
    } catch (const Stopped&) {
      PyErr_SetNone(PyExc_KeyboardInterrupt);
    }
  });
  pthread_atfork(nullptr, nullptr, [] { is_forked = is_used.load(); });

  module.def(
      "set_log",
      [](std::optional<nb::typed<nb::callable, void(int, std::string)>> call) {
        if (!call) {
          const nb::gil_scoped_release unlocked;
          setLogSink({});
          return;
        }
        const std::shared_ptr<nb::callable> function(new nb::callable(*call), [](nb::callable* held) {
          const nb::gil_scoped_acquire locked;
          delete held;
        });
        const LogSink sink = [function](LogLevel level, const std::string& message) {
          const nb::gil_scoped_acquire locked;
          try {
            (*function)(static_cast<int>(level), message);
          } catch (nb::python_error& failure) {
            // A message may be logged where no exception can pass: Ctrl-C is raised again by the next check
            // of signals, at the latest when the call is over.
            if (failure.matches(PyExc_KeyboardInterrupt)) {
              PyErr_SetInterrupt();
            } else {
              failure.discard_as_unraisable("emscape's log");
            }
          }
        };
        const nb::gil_scoped_release unlocked;
        setLogSink(sink);
      },
      nb::arg("call").none(),
      "Sends messages to call(level: 0 debug, 1 info, 2 warning; message); None: nowhere.");
}

}  // namespace emscape::python
