/// emscape: the electromagnetic environment of a scenario, computed, written and drawn from the command line.
#include <cstdio>
#include <cstdlib>

#include "apps/emscape/common/command_line.h"

int main(int argc, char** argv) {
  const int status = emscape::app::runCommandLine(argc, argv);
  if (status == 0) return 0;
  // HDF5 crashes in its exit handler after a netCDF file that met a full disk; all else is done.
  std::fflush(nullptr);
  std::_Exit(status);
}
