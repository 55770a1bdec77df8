// Where the sun stands in the sky.
#pragma once

#include "lobelia/base/vec.h"

namespace lobelia::io {

struct PlaceAndTime {
  int year = 2010, month = 7, day = 10;
  double hour = 15, minute = 0, second = 0;         // local time
  double latitude = 35.6894, longitude = 139.6917;  // degrees, north and east positive
  double timezone = 9;                              // hours east of Greenwich
};

// Unit vector towards the sun: x east, y up, z south. Good to 0.01 degrees from 1950 to 2050;
// without refraction.
Vec3d sunDirection(const PlaceAndTime& at);

}  // namespace lobelia::io
