/// Stopping in an orderly way on SIGINT, SIGTERM and SIGHUP.
#pragma once

#include "emscape/playback/stop.h"

namespace emscape::app {

/// Makes the first SIGINT, SIGTERM or SIGHUP set stopFlag(); a second one ends the program at once. A signal
/// that is ignored at the start stays ignored.
void catchInterrupts();

/// For commands that write no files and may be in a library's reader for long: from now on the first signal
/// that catchInterrupts() catches ends the program at once, with status 128 + N.
void endAtInterrupts();

/// Set once the user wants the program to stop.
const StopFlag& stopFlag();
/// The signal that set it; 0 before.
int caughtSignal();

/// @throws playback::Stopped if stopFlag() is set
void stopIfInterrupted();

}  // namespace emscape::app
