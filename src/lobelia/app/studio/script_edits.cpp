#include "lobelia/app/studio/script_edits.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>

#include "lobelia/app/studio/design_files.h"
#include "lobelia/app/studio/emitter_fields.h"
#include "lobelia/app/studio/material_edits.h"
#include "lobelia/app/studio/material_fields.h"
#include "lobelia/io/design.h"

namespace lobelia::app {
namespace {

using Kind = ScriptStep::Kind;

// The one that a name means; of several of that name, the first.
template <class T>
uint32_t named(const std::vector<T>& items, const char* kind, const std::string& name,
               const Location& where) {
  const std::vector<size_t> found = io::namedInDesign(items, name);
  if (!found.empty()) return static_cast<uint32_t>(found.front());
  const std::vector<std::string> names = io::designNames(items);
  std::string hint = suggestion(name, names);
  constexpr size_t kShown = 12;
  if (hint.empty() && !names.empty()) {
    const size_t shown = std::min(names.size(), kShown);
    hint =
        fmt::format("; there are {}{}",
                    fmt::join(names.begin(), names.begin() + static_cast<ptrdiff_t>(shown), ", "),
                    shown < names.size() ? "..." : "");
  }
  throw InputError(where, fmt::format("there is no {} '{}'{}", kind, name, hint));
}

void requireRange(const Rgb& value, float least, float most, int count, const std::string& word,
                  const Location& where) {
  for (int i = 0; i < count; ++i)
    if (!(value[i] >= least && value[i] <= most))
      throw InputError(
          where, fmt::format("{} is {}; it may be from {} to {}", word, value[i], least, most));
}

// One number, or three with commas.
Rgb numbers(const std::string& text, int count, const Location& where) {
  if (count == 1 || text.find(',') == std::string::npos)
    return Rgb(static_cast<float>(scriptNumber(text, where)));
  const Vec3d v = scriptVector(text, where);
  return {static_cast<float>(v.x), static_cast<float>(v.y), static_cast<float>(v.z)};
}

Rgb fieldNumber(const MaterialField& field, const std::string& text, const Location& where) {
  if (field.kind == FieldKind::map)
    throw InputError(where, fmt::format("{} is a map; give its file with `texture`", field.word));
  std::vector<std::string> words(field.choices.begin(), field.choices.end());
  if (field.kind == FieldKind::flag) words = {"off", "on"};
  if (!words.empty()) {
    const auto at = std::find(words.begin(), words.end(), text);
    if (at == words.end())
      throw InputError(where, fmt::format("{} is '{}'{}; it may be {}", field.word, text,
                                          suggestion(text, words), fmt::join(words, ", ")));
    return Rgb(static_cast<float>(at - words.begin()));
  }
  const Rgb value = numbers(text, field.kind == FieldKind::color ? 3 : 1, where);
  requireRange(value, field.least, field.most, 3, field.word, where);
  return value;
}

void changeMaterial(const ScriptStep& step, Design& design) {
  const std::string &word = step.words[1], &value = step.words[2];
  const uint32_t material = named(design.materials, "material", step.words[0], step.where);
  if (word == "type") {
    const std::optional<MaterialType> type = simpleType(value);
    if (!type) {
      std::vector<std::string> known;
      for (const MaterialType t : simpleTypes()) known.push_back(typeWord(t));
      throw InputError(step.where,
                       fmt::format("a material cannot become '{}'{}; it may be {}", value,
                                   suggestion(value, known), fmt::join(known, ", ")));
    }
    return changeType(design, material, *type);
  }
  const FieldPlace place = findField(design, material, word, step.where);
  setField(design.materials[place.material], *place.field,
           fieldNumber(*place.field, value, step.where));
}

void changeTexture(const ScriptStep& step, Design& design) {
  const uint32_t material = named(design.materials, "material", step.words[0], step.where);
  const FieldPlace place = findTexturable(design, material, step.words[1], step.where);
  const auto image = readImageFile(step.file, place.field->kind != FieldKind::color);
  setFieldTexture(design.materials[place.material], *place.field, addBitmap(design, image));
}

void changeMap(const ScriptStep& step, Design& design) {
  const uint32_t material = named(design.materials, "material", step.words[0], step.where);
  float scale = 1;
  if (step.words.size() > 1) {
    scale = static_cast<float>(scriptNumber(step.words[1], step.where));
    requireRange(Rgb(scale), -1e6f, 1e6f, 1, "the scale", step.where);
  }
  const TextureHandle map = addBitmap(design, readImageFile(step.file, true));
  if (step.kind == Kind::bump) {
    setBump(design, material, map, scale);
  } else {
    setNormalMap(design, material, map);
  }
}

void changeEmitter(const ScriptStep& step, Design& design) {
  const uint32_t index = named(design.emitters, "emitter", step.words[0], step.where);
  Emitter& emitter = design.emitters[index];
  const EmitterFieldInfo& info = findEmitterField(emitter.type, step.words[1], step.where);
  const Rgb value = numbers(step.words[2], info.values, step.where);
  requireRange(value, info.least, info.most, info.values, info.word, step.where);
  setEmitterValue(emitter, info.field, value);
}

// A design has one at most (io/design.h), which takes the place of the scene's.
void requireNoEnvironment(const ScriptStep& step, const Design& design) {
  const auto is = [](const Emitter& e) {
    return e.type == EmitterType::constant || e.type == EmitterType::environment;
  };
  const auto at = std::find_if(design.emitters.begin(), design.emitters.end(), is);
  if (at == design.emitters.end()) return;
  throw InputError(step.where,
                   fmt::format("there is light from all around already: the emitter '{}'; change "
                               "it by `emitter`, or exchange it by `environment FILE`",
                               io::designName(design.emitters,
                                              static_cast<size_t>(at - design.emitters.begin()))));
}

void addLight(const ScriptStep& step, Design& design) {
  const auto& w = step.words;
  if (w.size() < 4)
    throw InputError(step.where, "what is right here is: light add TYPE X,Y,Z R,G,B [NAME]");
  constexpr EmitterType kTypes[] = {EmitterType::point, EmitterType::spot, EmitterType::directional,
                                    EmitterType::constant};
  std::vector<std::string> known;
  for (const EmitterType type : kTypes) known.push_back(typeWord(type));
  const auto at = std::find(known.begin(), known.end(), w[1]);
  if (at == known.end())
    throw InputError(step.where, fmt::format("a light cannot be '{}'{}; it may be {}", w[1],
                                             suggestion(w[1], known), fmt::join(known, ", ")));
  const EmitterType type = kTypes[at - known.begin()];
  if (type == EmitterType::constant) requireNoEnvironment(step, design);
  const Vec3f place = numbers(w[2], 3, step.where);
  const Rgb light = numbers(w[3], 3, step.where);
  requireRange(light, 0, 1e9f, 3, "the light", step.where);
  requireRange(place, -1e9f, 1e9f, 3, "the place", step.where);
  Emitter emitter = newEmitter(type, w.size() > 4 ? w[4] : freeLightName(design), place, light);
  if (type == EmitterType::directional) {
    if (!(length(place) > 1e-6f)) throw InputError(step.where, "the direction has no length");
    setEmitterValue(emitter, EmitterField::direction, normalize(place));
  }
  if (!io::namedInDesign(design.emitters, emitter.name).empty())
    throw InputError(step.where, fmt::format("there is an emitter '{}' already", emitter.name));
  design.emitters.push_back(std::move(emitter));
}

void removeLight(const ScriptStep& step, Design& design) {
  const uint32_t index = named(design.emitters, "emitter", step.words[1], step.where);
  if (index < design.sceneEmitters)
    throw InputError(step.where, "this light is the scene's and stays; set its strength to 0");
  design.emitters.erase(design.emitters.begin() + index);
}

void changeLights(const ScriptStep& step, Design& design) {
  if (step.words[0] == "add") return addLight(step, design);
  if (step.words[0] == "remove" && step.words.size() == 2) return removeLight(step, design);
  throw InputError(
      step.where, "what is right here is: light add TYPE X,Y,Z R,G,B [NAME], or light remove NAME");
}

}  // namespace

bool isEdit(Kind kind) {
  return kind == Kind::material || kind == Kind::texture || kind == Kind::bump ||
         kind == Kind::normalMap || kind == Kind::emitter || kind == Kind::light;
}

std::string editName(const ScriptStep& step) {
  return fmt::format("{}", fmt::join(step.words, " "));
}

void applyEdit(const ScriptStep& step, Design& design) {
  switch (step.kind) {
    case Kind::material:
      return changeMaterial(step, design);
    case Kind::texture:
      return changeTexture(step, design);
    case Kind::bump:
    case Kind::normalMap:
      return changeMap(step, design);
    case Kind::emitter:
      return changeEmitter(step, design);
    case Kind::light:
      return changeLights(step, design);
    default:
      break;
  }
}

}  // namespace lobelia::app
