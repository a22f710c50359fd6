/// Signals of the programs: an orderly shutdown on SIGINT, SIGTERM, SIGHUP and SIGXCPU.
#pragma once

#include "emscape/base/work.h"

namespace emscape::app {

/// Makes the first SIGINT, SIGTERM or SIGHUP set stopFlag(); a second one, more than a second later, ends the
/// program at once, as do 20 s in which it has not ended. SIGXCPU (the limit of processor time, repeated each
/// second) sets it, too. A signal that is ignored at the start stays ignored. At SIGPIPE (a closed pipe) and
/// SIGXFSZ (the limit of a file's size) the write fails instead.
void handleSignals();

/// For processes that another one of this program ends: a signal to the group of both comes from both.
void ignoreFurtherSignals();

/// For commands that may spend a long time in a library's reader: while an object exists, and no file is
/// being written, the first signal that handleSignals() catches ends the program at once, with status 128 +
/// N.
class EndAtInterrupts {
 public:
  EndAtInterrupts();
  ~EndAtInterrupts();
  EndAtInterrupts(const EndAtInterrupts&) = delete;
  EndAtInterrupts& operator=(const EndAtInterrupts&) = delete;
};

/// Is set when the user stops the program.
const StopFlag& stopFlag();
/// The signal that set stopFlag(); 0 before.
int caughtSignal();

/// @throws Stopped if stopFlag() is set
void stopIfInterrupted();

}  // namespace emscape::app
