/// emscape: the electromagnetic environment of a scenario, computed, written and drawn from the command line.
#include "apps/emscape/subcommands.h"

int main(int argc, char** argv) {
  return emscape::app::runProgram({argv + 1, argv + argc}, emscape::app::addSubcommands);
}
