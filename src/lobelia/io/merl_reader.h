// Files of the MERL BRDF database [Matusik03]: three 32-bit dimensions (90, 90, 180), then red,
// green and blue tables of doubles in units of 1/1500, 1.15/1500 and 1.66/1500 per steradian,
// little-endian. Negative values are what could not be measured.
#pragma once

#include <string>

#include "lobelia/base/error.h"
#include "lobelia/bsdf/captured_fit.h"
#include "lobelia/bsdf/tabulated_brdf.h"
#include "lobelia/scene/material.h"

namespace lobelia::io {

// Throws InputError: at `from` when the file cannot be read, at the file when it is no such table
// or holds nothing measured. Values that are not finite count as not measured.
TabulatedBrdf readMerl(const std::string& file, const Location& from = {});
// Valid entries are written as they read back, to double precision.
void writeMerl(const std::string& file, const TabulatedBrdf& table);

// "3 lobes, error 4.1 %, energy within 0.3 % ...": for findings and the command line.
std::string describeFit(const TabulatedBrdf& table, const CapturedFit& fit);
// What a user should know before trusting the fit; "" when it is close.
std::string doubtsAbout(const TabulatedBrdf& table, const CapturedFit& fit);
Material materialOf(const CapturedFit& fit);
// A Mitsuba file with nothing but this material, to be included by scenes: `<include
// filename=.../>`, then `<ref id=.../>`. Written by io/mitsuba/captured.cpp.
void writeFit(const std::string& file, const CapturedFit& fit, const std::string& id);

}  // namespace lobelia::io
