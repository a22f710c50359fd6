/// emscape: the electromagnetic environment of a scenario, computed, written and drawn from the command line.
#include <cstdio>
#include <cstdlib>

#include "apps/emscape/common/command_line.h"

int main(int argc, char** argv) {
  const int status = emscape::app::runCommandLine(argc, argv);
  if (status == 0) return 0;
  // After a netCDF file could not be written to a full disk, HDF5 crashes in its exit handler. Nothing else
  // is left to do here.
  std::fflush(nullptr);
  std::_Exit(status);
}
