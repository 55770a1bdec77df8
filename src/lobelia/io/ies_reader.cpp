// ANSI/IESNA LM-63-2002 "Standard File Format for the Electronic Transfer of Photometric Data", and
// its forerunners of 1986, 1991 and 1995: they differ in the first line, in keywords (which are
// skipped) and in the meaning of the 12th number, ballast lamp factor then, future use now.
//
// Type C is taken as it is. Types B and A (floodlights, headlamps) give angles around an axis in
// the plane of the opening instead of around the straight-ahead direction; they are turned into
// type C by evaluating theirs at C's directions. There, straight ahead (0, 0) becomes straight
// down, positive horizontal angles the plane C0, positive vertical angles C90.
//
// Not read: the tilt table of lamps whose light depends on how they are held (TILT=INCLUDE gives
// its place, but scenes do not know how a luminaire hangs); TILT=file likewise. Both are reported.
#include "lobelia/io/ies_reader.h"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <string_view>

#include "lobelia/io/file_bytes.h"

namespace lobelia::io {
namespace {

constexpr double kPiD = 3.14159265358979323846;
constexpr double kTolerance = 1e-3;  // degrees, of the ends of angle ranges
constexpr int kMaxAngles = 20000;

bool isSpace(char c) { return c == ' ' || c == '\t' || c == '\r' || c == '\n' || c == ','; }

class Parser {
 public:
  Parser(std::string bytes, const std::string& file) : bytes_(std::move(bytes)), file_(file) {}

  Location where() const { return {file_, line_, 0}; }
  [[noreturn]] void refuse(const std::string& what) const { throw InputError(where(), what); }

  // The next line without spaces at its ends; empty at the end of the file.
  bool nextLine(std::string_view* out) {
    if (at_ >= bytes_.size()) return false;
    const size_t start = at_;
    size_t end = bytes_.find_first_of("\r\n", start);
    if (end == std::string::npos) end = bytes_.size();
    at_ = end;
    if (at_ < bytes_.size() && bytes_[at_] == '\r') ++at_;
    if (at_ < bytes_.size() && bytes_[at_] == '\n') ++at_;
    ++line_;
    std::string_view text(bytes_.data() + start, end - start);
    while (!text.empty() && isSpace(text.back())) text.remove_suffix(1);
    while (!text.empty() && isSpace(text.front())) text.remove_prefix(1);
    *out = text;
    return true;
  }

  // Numbers may stand on any number of lines.
  double number(const char* what) {
    while (rest_.empty()) {
      if (!nextLine(&rest_))
        refuse(fmt::format("the file ends where {} should be; it was cut short", what));
    }
    size_t end = 0;
    while (end < rest_.size() && !isSpace(rest_[end])) ++end;
    std::string_view word = rest_.substr(0, end);
    rest_.remove_prefix(end);
    while (!rest_.empty() && isSpace(rest_.front())) rest_.remove_prefix(1);
    const std::string_view given = word;
    if (word.starts_with('+')) word.remove_prefix(1);
    double value = 0;
    const auto [next, error] = std::from_chars(word.data(), word.data() + word.size(), value);
    if (error != std::errc() || next != word.data() + word.size() || !std::isfinite(value))
      refuse(fmt::format("'{}' is not a number; {} should stand here", given.substr(0, 40), what));
    return value;
  }
  int count(const char* what, int most) {
    const double value = number(what);
    if (!(value >= 1 && value <= most) || value != std::floor(value))
      refuse(fmt::format("{} is {:g}; it should be an integer from 1 to {}", what, value, most));
    return static_cast<int>(value);
  }
  std::vector<double> numbers(size_t count, const char* what) {
    std::vector<double> values;
    // Each takes two characters at least: no count makes us allocate more than the file holds.
    if (count / 2 > bytes_.size())
      refuse(fmt::format("{} numbers of {} cannot fit into this file", count, what));
    values.reserve(count);
    for (size_t i = 0; i < count; ++i) values.push_back(number(what));
    return values;
  }
  std::vector<double> angles(size_t count, const char* what) {
    std::vector<double> values = numbers(count, what);
    for (size_t i = 1; i < count; ++i)
      if (!(values[i] > values[i - 1]))
        refuse(fmt::format("{} do not increase: {:g} after {:g}", what, values[i], values[i - 1]));
    return values;
  }
  bool hasMore() {
    while (rest_.empty())
      if (!nextLine(&rest_)) return false;
    return true;
  }

 private:
  std::string bytes_, file_;
  size_t at_ = 0;
  int line_ = 0;
  std::string_view rest_;  // of a line of numbers
};

// The lines up to TILT=; returns what stands there.
std::string header(Parser& parser, std::vector<Finding>& findings) {
  std::string_view line;
  if (!parser.nextLine(&line)) parser.refuse("the file is empty; an IES file begins with IESNA");
  const bool hasVersion = line.starts_with("IES");  // LM-63-1986 has no such line
  if (hasVersion && line.starts_with("IESNA") && line.find("LM-63") == std::string_view::npos &&
      line.find("91") == std::string_view::npos) {
    findings.push_back(
        {Severity::warning, parser.where(),
         fmt::format("unknown version '{}'; read as IESNA:LM-63-2002", line.substr(0, 40))});
  }
  constexpr int kMaxHeaderLines = 10000;
  for (int i = 0; i < kMaxHeaderLines; ++i) {
    if (line.starts_with("TILT")) {
      const size_t equals = line.find('=');
      if (equals == std::string_view::npos) break;
      std::string_view tilt = line.substr(equals + 1);
      while (!tilt.empty() && isSpace(tilt.front())) tilt.remove_prefix(1);
      return std::string(tilt);
    }
    if (!parser.nextLine(&line)) break;
  }
  parser.refuse("no line TILT=NONE or TILT=INCLUDE; this is not an IES photometric file");
}

void tilt(Parser& parser, const std::string& value, std::vector<Finding>& findings) {
  if (value == "NONE") return;
  if (value == "INCLUDE") {
    parser.number("the lamp-to-luminaire geometry");
    const size_t pairs = static_cast<size_t>(parser.count("the number of tilt angles", kMaxAngles));
    parser.numbers(pairs, "tilt angles");
    parser.numbers(pairs, "tilt multipliers");
    findings.push_back({Severity::warning, parser.where(),
                        "TILT=INCLUDE: the tilt table is ignored; intensities are those of the "
                        "luminaire as it was measured"});
    return;
  }
  findings.push_back({Severity::warning, parser.where(),
                      fmt::format("TILT={}: the tilt file is ignored; intensities are those of the "
                                  "luminaire as it was measured",
                                  value)});
}

bool isNear(double a, double b) { return std::abs(a - b) <= kTolerance; }

// The ranges that the standard allows; anything else means that the file is misread.
void checkRanges(const Parser& parser, const IesPhotometry& p) {
  const double v0 = p.vertical.front(), v1 = p.vertical.back();
  const double h0 = p.horizontal.front(), h1 = p.horizontal.back();
  if (p.type == 1) {
    if (v0 < -kTolerance || v1 > 180 + kTolerance)
      parser.refuse(fmt::format(
          "vertical angles from {:g} to {:g}; type C has them between 0 and 180", v0, v1));
    const bool known = isNear(h0, 0) && (p.horizontal.size() == 1 || isNear(h1, 90) ||
                                         isNear(h1, 180) || (h1 > 180 && h1 <= 360 + kTolerance));
    const bool sideways = isNear(h0, 90) && isNear(h1, 270);
    if (!known && !sideways)
      parser.refuse(
          fmt::format("horizontal angles from {:g} to {:g}; type C has 0, or 0 to 90, 180 "
                      "or 360, or 90 to 270",
                      h0, h1));
    return;
  }
  // The latitude reaches 90 degrees either way, the angle around the axis 180.
  const double mostV = p.type == 3 ? 90 : 180, mostH = p.type == 3 ? 180 : 90;
  if (v0 < -mostV - kTolerance || v1 > mostV + kTolerance)
    parser.refuse(fmt::format("vertical angles from {:g} to {:g}; this type has -{:g} to {:g}", v0,
                              v1, mostV, mostV));
  if (h0 > kTolerance || h0 < -mostH - kTolerance || h1 > mostH + kTolerance)
    parser.refuse(fmt::format(
        "horizontal angles from {:g} to {:g}; this type has 0 to {:g}, or -{:g} to {:g}", h0, h1,
        mostH, mostH, mostH));
}

// Position among increasing values: index of the lower neighbour and fraction; false outside.
bool locate(const std::vector<double>& values, double x, size_t* index, double* fraction) {
  if (values.size() == 1) {
    *index = 0, *fraction = 0;
    return true;
  }
  if (x < values.front() - kTolerance || x > values.back() + kTolerance) return false;
  const auto above = std::upper_bound(values.begin() + 1, values.end() - 1, x);
  *index = static_cast<size_t>(above - values.begin()) - 1;
  *fraction = std::clamp((x - values[*index]) / (values[*index + 1] - values[*index]), 0.0, 1.0);
  return true;
}

double table(const IesPhotometry& p, double vertical, double horizontal) {
  size_t i, j;
  double f, g;
  // A single vertical angle measures one direction only.
  if (p.vertical.size() == 1 && !isNear(vertical, p.vertical[0])) return 0;
  if (!locate(p.vertical, vertical, &i, &f) || !locate(p.horizontal, horizontal, &j, &g)) return 0;
  const size_t n = p.vertical.size();
  const auto at = [&](size_t row) {
    const double a = p.candela[row * n + i];
    return f > 0 ? a + (p.candela[row * n + i + 1] - a) * f : a;
  };
  const double a = at(j);
  return g > 0 ? a + (at(j + 1) - a) * g : a;
}

// Azimuth folded into what was measured.
double foldC(const IesPhotometry& p, double around) {
  around = std::fmod(around, 360.0);
  if (around < 0) around += 360;
  const double last = p.horizontal.back();
  if (p.horizontal.size() == 1) return p.horizontal[0];
  if (isNear(p.horizontal.front(), 90)) {  // 90 to 270: mirrored in the plane C90-C270
    if (around < 90) return 180 - around;
    return around > 270 ? 540 - around : around;
  }
  if (last > 180 + kTolerance) return around;
  if (around > 180) around = 360 - around;
  if (isNear(last, 90) && around > 90) around = 180 - around;
  return around;
}

}  // namespace

double IesPhotometry::at(double down, double around) const {
  if (type == 1) {
    const double last = horizontal.back();
    double folded = foldC(*this, around);
    // All round without the repeated last plane: it closes with the first.
    if (last > 180 + kTolerance && folded > last && !isNear(last, 360)) {
      const double g = (folded - last) / (360 - last);
      return multiplier * (table(*this, down, last) * (1 - g) + table(*this, down, 0) * g);
    }
    return multiplier * table(*this, down, folded);
  }
  const double theta = down * kPiD / 180, phi = around * kPiD / 180;
  const double x = std::sin(theta) * std::cos(phi), y = std::sin(theta) * std::sin(phi),
               z = std::cos(theta);
  const double degrees = 180 / kPiD;
  // A: the axis is vertical (y), the horizontal angle turns around it. B: the axis is horizontal
  // (x), the vertical angle turns around it.
  double v, h;
  if (type == 3) {
    v = std::asin(std::clamp(y, -1.0, 1.0)) * degrees;
    h = std::atan2(x, z) * degrees;
  } else {
    v = std::atan2(y, z) * degrees;
    h = std::asin(std::clamp(x, -1.0, 1.0)) * degrees;
  }
  if (isNear(horizontal.front(), 0) && h < 0) h = -h;
  return multiplier * table(*this, v, h);
}

IesPhotometry readIes(const std::string& file, const Location& from,
                      std::vector<Finding>& findings) {
  Parser parser(readFileBytes(file, "photometry", from), file);
  tilt(parser, header(parser, findings), findings);
  IesPhotometry p;
  p.lamps = static_cast<int>(parser.count("the number of lamps", 1000000));
  p.lumens = parser.number("lumens per lamp");
  const double multiplier = parser.number("the candela multiplier");
  const int verticalCount = parser.count("the number of vertical angles", kMaxAngles);
  const int horizontalCount = parser.count("the number of horizontal angles", kMaxAngles);
  p.type = parser.count("the photometric type", 3);
  parser.count("the type of units", 2);
  for (const char* what : {"the width", "the length", "the height"}) parser.number(what);
  const double ballast = parser.number("the ballast factor");
  double lampFactor = parser.number("the ballast-lamp factor");
  parser.number("the input watts");
  if (lampFactor == 0) lampFactor = 1;  // "future use" of later editions, which some leave at 0
  p.multiplier = multiplier * ballast * lampFactor;
  if (!(p.multiplier > 0))
    parser.refuse(
        fmt::format("candela multiplier {:g}, ballast factor {:g}, ballast-lamp factor "
                    "{:g}: their product must be above 0",
                    multiplier, ballast, lampFactor));
  p.vertical = parser.angles(static_cast<size_t>(verticalCount), "the vertical angles");
  p.horizontal = parser.angles(static_cast<size_t>(horizontalCount), "the horizontal angles");
  checkRanges(parser, p);
  p.candela = parser.numbers(p.vertical.size() * p.horizontal.size(), "the candela values");
  for (const double c : p.candela)
    if (c < 0) parser.refuse(fmt::format("a candela value of {:g}; intensities are 0 or more", c));
  if (parser.hasMore())
    findings.push_back(
        {Severity::warning, parser.where(), "more follows the candela values; it is ignored"});
  return p;
}

namespace {

// Steps of `turn` degrees that all angles are multiples of (to a hundredth of a step), no wider
// than their least distance or five degrees: the fewest, or steps of 0.1 degrees when there are
// none.
int evenSteps(const std::vector<double>& angles, double turn) {
  constexpr double kWidest = 5, kFinest = 0.1, kOff = 0.01;
  double least = kWidest;
  for (size_t i = 1; i < angles.size(); ++i) least = std::min(least, angles[i] - angles[i - 1]);
  const int most = static_cast<int>(std::lround(turn / kFinest));
  for (int n = static_cast<int>(std::ceil(turn / std::max(least, kFinest) - kOff)); n < most; ++n) {
    const auto isMultiple = [&](double angle) {
      const double steps = angle * n / turn;
      return std::abs(steps - std::round(steps)) <= kOff;
    };
    if (std::all_of(angles.begin(), angles.end(), isMultiple)) return n;
  }
  return most;
}

}  // namespace

Image iesImage(const IesPhotometry& photometry, const std::string& name) {
  Image image;
  image.name = name;
  image.channels = 1;
  // The angles of types A and B run around other axes: as fine a grid as that of the finer ones.
  const bool isC = photometry.type == 1;
  const int down = evenSteps(photometry.vertical, 180);
  const int around = evenSteps(photometry.horizontal, 360);
  image.height = (isC ? down : std::max(down, around / 2)) + 1;
  image.width = isC ? around : std::min(2 * std::max(2 * down, around), 3600);
  if (isC && photometry.horizontal.size() == 1) image.width = 1;
  image.pixels.reserve(static_cast<size_t>(image.width) * static_cast<size_t>(image.height));
  for (int y = 0; y < image.height; ++y) {
    for (int x = 0; x < image.width; ++x) {
      image.pixels.push_back(static_cast<float>(
          photometry.at(y * 180.0 / (image.height - 1), x * 360.0 / image.width)));
    }
  }
  return image;
}

double iesTurn(const Image& image) { return image.width > 1 ? -180.0 / image.width : 0; }

}  // namespace lobelia::io
