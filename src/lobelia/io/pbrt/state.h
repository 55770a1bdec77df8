// The graphics state of a PBRT file: what directives set and later ones use.
#pragma once

#include <map>
#include <memory>
#include <string>
#include <vector>

#include "lobelia/base/transform.h"
#include "lobelia/io/pbrt/colors.h"
#include "lobelia/io/pbrt/parameters.h"
#include "lobelia/scene/handle.h"

namespace lobelia::io::pbrt {

// An AreaLightSource directive, used by the shapes that follow it.
struct AreaLight {
  std::string type;
  std::vector<Parameter> parameters;
  Location where;
  ColorSpace colorSpace;
  bool wasUsed = false;
  EmitterHandle emitter;  // once a shape has used it; shapes share it unless it gives its power
};

struct State {
  Mat4 ctm;
  bool atStart = true, atEnd = true;  // ActiveTransform; only the start's matrix is kept
  bool reverseOrientation = false;
  MaterialHandle material;  // when materialName is empty; invalid: the default
  std::string materialName;
  Location materialWhere;
  std::shared_ptr<AreaLight> areaLight;
  std::string mediumInside, mediumOutside;
  ColorSpace colorSpace;
  std::map<std::string, std::vector<Parameter>> defaults;  // Attribute, by its target
};

// A homogeneous medium that absorbs and does not scatter can be a property of glass; other media
// are not supported.
struct Medium {
  bool isAbsorbing = false;
  Rgb absorption;
};

}  // namespace lobelia::io::pbrt
