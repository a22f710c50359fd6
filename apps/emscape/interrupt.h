/// Stopping in an orderly way on SIGINT, SIGTERM and SIGHUP.
#pragma once

#include "emscape/playback/stop.h"

namespace emscape::app {

/// Makes the first SIGINT, SIGTERM or SIGHUP set stopFlag(); a second one ends the program at once. A signal
/// that is ignored at the start stays ignored.
void catchInterrupts();

/// Set once the user wants the program to stop.
const StopFlag& stopFlag();
/// The signal that set it; 0 before.
int caughtSignal();

/// @throws playback::Stopped if stopFlag() is set
void stopIfInterrupted();

}  // namespace emscape::app
