// The Astronomical Almanac's low-precision formulas as given by Michalsky 1988 ("The Astronomical
// Almanac's algorithm for approximate solar position (1950-2050)", Solar Energy 40). Days are
// counted from the epoch J2000 by the rule of the Gregorian calendar.
#include "lobelia/io/sun_position.h"

namespace lobelia::io {
namespace {

constexpr double kDegree = 3.14159265358979323846 / 180;

// Days from noon of 1 January 2000 (J2000) to midnight of a date.
double daysFromJ2000(int year, int month, int day) {
  // Years start in March, so that the day of February's end comes last.
  const int y = month > 2 ? year : year - 1, m = (month + 9) % 12;
  const auto floorDivide = [](int a, int b) { return a / b - (a % b < 0 ? 1 : 0); };
  const int days = 365 * y + floorDivide(y, 4) - floorDivide(y, 100) + floorDivide(y, 400) +
                   (m * 306 + 5) / 10 + (day - 1);
  constexpr int kJ2000 = 730425;  // the same count for 1 January 2000
  return days - kJ2000 - 0.5;
}

}  // namespace

Vec3d sunDirection(const PlaceAndTime& at) {
  const double hours = at.hour - at.timezone + (at.minute + at.second / 60) / 60;  // universal time
  const double n = daysFromJ2000(at.year, at.month, at.day) + hours / 24;
  const double meanLongitude = 280.460 + 0.9856474 * n;
  const double anomaly = (357.528 + 0.9856003 * n) * kDegree;
  const double longitude =
      (meanLongitude + 1.915 * std::sin(anomaly) + 0.020 * std::sin(2 * anomaly)) * kDegree;
  const double obliquity = (23.439 - 0.0000004 * n) * kDegree;
  const double rightAscension =
      std::atan2(std::cos(obliquity) * std::sin(longitude), std::cos(longitude));
  const double declination = std::asin(std::sin(obliquity) * std::sin(longitude));
  const double siderealHours = 6.697375 + 0.0657098242 * n + hours;  // Greenwich
  const double hourAngle = (siderealHours * 15 + at.longitude) * kDegree - rightAscension;
  const double latitude = at.latitude * kDegree;
  const double south = std::sin(latitude) * std::cos(declination) * std::cos(hourAngle) -
                       std::cos(latitude) * std::sin(declination);
  const double up = std::sin(latitude) * std::sin(declination) +
                    std::cos(latitude) * std::cos(declination) * std::cos(hourAngle);
  return normalize(Vec3d{-std::cos(declination) * std::sin(hourAngle), up, south});
}

}  // namespace lobelia::io
