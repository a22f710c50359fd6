/// Stopping in an orderly way on SIGINT and SIGTERM.
#pragma once

#include "emscape/base/progress.h"

namespace emscape::app {

/// Makes the first SIGINT or SIGTERM set stopFlag(); a second one ends the program at once.
void catchInterrupts();

/// Set once the user wants the program to stop.
const StopFlag& stopFlag();

/// Thrown between two steps of the work after a signal. What is finished stays.
struct Interrupted {
  int signal = 0;
};

/// @throws Interrupted if stopFlag() is set
void stopIfInterrupted();

}  // namespace emscape::app
