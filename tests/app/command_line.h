// What tests of the command line share.
#pragma once

#include <gtest/gtest.h>

#include "support/run_program.h"

namespace lobelia::test {

inline constexpr const char* kSmall = "render cornell --detail 0.1 --size 24x24 --quiet ";

// Whatever was missing or wrong: one line that names it, the contract's code, nothing written.
inline void expectFailure(const std::string& arguments, int code, const std::string& mentions) {
  const ProgramResult r = runProgram(arguments);
  EXPECT_EQ(r.exitCode, code) << arguments << "\n" << r.err;
  EXPECT_NE(r.err.find(mentions), std::string::npos) << arguments << "\nsaid: " << r.err;
  EXPECT_EQ(r.err.find('\033'), std::string::npos) << "control codes without a terminal";
}

}  // namespace lobelia::test
