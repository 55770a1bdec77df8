// From a film to what a screen shows: tone mapping, false colours with their range, a split between
// the method's picture and the truth.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "lobelia/app/studio/picture.h"

namespace lobelia::app {

// luminance: of the picture, in its units (W / (sr m^2) where the scene's are, weighted as
// luminance). illuminance: irradiance, pi times what a white diffuse surface in every place shows
// (ViewState::white), weighted likewise; light straight from emitters alone. cost:
// ViewState::cost. samples: per pixel. error: |picture - truth| over the truth's luminance (and 1 %
// of its mean) where there is a truth, else the estimated standard error over the picture's.
enum class Shown : uint8_t { picture, luminance, illuminance, cost, samples, error };
const std::vector<std::string>& shownNames();  // as scripts have them, in that order

struct DisplaySettings {
  int width = 0, height = 0;  // of what comes out; 0: the picture's
  Shown shown = Shown::picture;
  // Automatic scale, measured by measureToneCurve() when the person asks for it, and stops on top.
  ToneCurve curve;
  float exposure = 0;
  // Range of false colours: the least and the most, or by the 1st and 99th percentile of the
  // values.
  bool fixedRange = false;
  float least = 0, most = 1;
  bool logarithmic = false;  // colours by decades; what is 0 or less has the lowest
  // Left of this share of the width the picture, right of it the truth, a white line between; below
  // 0, or without a truth: the picture alone.
  float split = -1;
};

struct Displayed {
  int width = 0, height = 0;
  std::vector<uint8_t> pixels;  // RGBA, sRGB, top row first
  float least = 0, most = 0;    // false colours: what the ends of the scale stand for
};
// truth: may be null. Sizes may differ: pixels are those nearest. Not finite: magenta.
Displayed displayPicture(const Picture& picture, const Picture* truth,
                         const DisplaySettings& settings);

// Why a picture cannot be shown so (it lacks what is asked for), or "".
std::string whyNotShown(const Picture& picture, const Picture* truth, Shown shown);

// Why a picture of such a part of light (Picture::part) has no truth to compare it with, or "".
std::string whyNoTruth(const std::string& part);

// Colours of a legend from the least (first) to the most: `count` times RGBA.
std::vector<uint8_t> legendColors(int count);

}  // namespace lobelia::app
