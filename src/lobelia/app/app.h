// The command line program.
#pragma once

namespace lobelia::app {

// Parses the command line, runs the command, returns the contract's exit code.
int run(int argc, char** argv);

}  // namespace lobelia::app
