// Photometry of luminaires: IES LM-63 files.
#pragma once

#include <string>
#include <vector>

#include "lobelia/base/error.h"
#include "lobelia/scene/scene.h"

namespace lobelia::io {

// What a file says, symmetries as they stand there.
struct IesPhotometry {
  int type = 1;           // photometric type: 1: C, 2: B, 3: A
  double multiplier = 1;  // candela multiplier times ballast factors
  double lumens = -1;     // of a lamp; -1: absolute photometry
  int lamps = 1;
  std::vector<double> vertical, horizontal;  // degrees, increasing
  std::vector<double> candela;               // horizontal.size() rows of vertical.size()

  // Candela times the multiplier towards a direction of the luminaire: C: `down` degrees from
  // straight down (0..180), `around` degrees from the plane C0. 0 outside of what was measured.
  double at(double down, double around) const;
};

// LM-63 of 1986, 1991, 1995, 2002 and 2019. Throws InputError with the line. Warnings are appended
// to `findings`.
IesPhotometry readIes(const std::string& file, const Location& from,
                      std::vector<Finding>& findings);
// Candela as the image of a goniometric emitter: straight down is local +z. One grey channel. Rows
// and columns lie on the measured angles, where these are multiples of 0.1 degrees or of another
// step as wide: peaks keep their heights. So the first column's centre is the plane C0, half a
// column past local +x: the emitter's transform times a turn about +z by iesTurn() degrees brings
// C0 to local +x, C90 to local +y.
Image iesImage(const IesPhotometry& photometry, const std::string& name);
double iesTurn(const Image& image);

}  // namespace lobelia::io
