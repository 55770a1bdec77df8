// What of a material can be changed, for panels and scripts: one table (material_fields.cpp).
#pragma once

#include <optional>
#include <span>
#include <string>
#include <vector>

#include "lobelia/app/studio/design.h"

namespace lobelia::app {

// color, scalar: may be driven by a texture where `texturable`; number: a plain value; choice: one
// of `choices` by index; flag: 0 or 1; map: a texture alone.
enum class FieldKind : uint8_t { color, scalar, number, choice, flag, map };

struct MaterialField {
  const char* label;  // for people
  const char* word;   // in scripts
  FieldKind kind = FieldKind::scalar;
  float least = 0, most = 1;  // of values (of each component of a colour); choices: of indices
  bool logarithmic = false;   // how a slider should run
  bool texturable = false;
  std::span<const char* const> choices{};
  // Where the value is, by kind.
  ColorParam Material::*color = nullptr;
  FloatParam Material::*scalar = nullptr;
  FloatParam Material::*also = nullptr;  // a second one that is set along
  float Material::*number = nullptr;
  Rgb Material::*plainColor = nullptr;
  bool Material::*flag = nullptr;
  int Material::*index = nullptr;  // choices; null: of the distribution
  TextureHandle Material::*map = nullptr;
};

// Types that a material may be changed to: those that do not wrap others.
std::span<const MaterialType> simpleTypes();
const char* typeWord(MaterialType type);                     // as Mitsuba's plugin; every type
std::optional<MaterialType> simpleType(const std::string&);  // by its word

// Of one material of a type, what it wraps left out.
std::span<const MaterialField> fieldsOf(MaterialType type);

// A field of a material or of what it wraps.
struct FieldPlace {
  uint32_t material = 0;  // whose field it is
  std::string prefix;     // "": of what one sees first; "back.", "second." of the other side
  const MaterialField* field = nullptr;
};
// All of a material and of what it wraps, outermost first.
std::vector<FieldPlace> fieldPlaces(const Design& design, uint32_t material);
// The field of a word, with its prefix. Throws InputError with near words and those that there are.
FieldPlace findField(const Design& design, uint32_t material, const std::string& word,
                     const Location& where);
// The same, of a field that a texture can drive.
FieldPlace findTexturable(const Design& design, uint32_t material, const std::string& word,
                          const Location& where);

// Values; x alone for all kinds but colours.
Rgb fieldValue(const Material& material, const MaterialField& field);
TextureHandle fieldTexture(const Material& material, const MaterialField& field);
// Brought into the field's range; takes the place of a texture.
void setField(Material& material, const MaterialField& field, Rgb value);
// An invalid handle takes the texture away. Not for fields without.
void setFieldTexture(Material& material, const MaterialField& field, TextureHandle texture);

}  // namespace lobelia::app
