// What of an emitter can be changed, for panels and scripts. Light is a colour (largest component
// 1) times a strength.
#pragma once

#include <span>
#include <string>
#include <vector>

#include "lobelia/app/studio/design.h"

namespace lobelia::app {

// color, strength: the light; place: where it is; direction: where it shines to, unit; angle:
// degrees; number: any other.
enum class EmitterField : uint8_t {
  color,
  strength,
  position,
  direction,
  cutoff,
  beamWidth,
  fieldOfView,
  angularRadius
};
struct EmitterFieldInfo {
  EmitterField field;
  const char* label;          // for people
  const char* word;           // in scripts
  int values = 1;             // 1 or 3
  float least = 0, most = 1;  // of each; of positions: no bounds
  bool logarithmic = false;
};

std::span<const EmitterFieldInfo> emitterFields(EmitterType type);
const char* typeWord(EmitterType type);  // as Mitsuba's plugin
// By its word; throws InputError with near words and those that there are.
const EmitterFieldInfo& findEmitterField(EmitterType type, const std::string& word,
                                         const Location& where);
// Values; x alone where there is one. Angles in degrees.
Vec3f emitterValue(const Emitter& emitter, EmitterField field);
// Brought into range. What is not finite, and a direction of length 0, changes nothing.
void setEmitterValue(Emitter& emitter, EmitterField field, Vec3f value);

// New lights: of types point, spot (down), directional (down), constant. The intensity of a point
// of strength 1 is 1 W/sr.
// freeLightName(): light1, light2... that nothing has.
std::string freeLightName(const Design& design);
Emitter newEmitter(EmitterType type, const std::string& name, Vec3f position, Rgb light);

}  // namespace lobelia::app
