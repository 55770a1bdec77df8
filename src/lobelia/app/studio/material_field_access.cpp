// Fields of the table found, read and set.
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>

#include "lobelia/app/studio/material_fields.h"

namespace lobelia::app {
namespace {

void collect(const Design& design, uint32_t material, const std::string& prefix, int depth,
             std::vector<FieldPlace>& out) {
  constexpr int kMostNested = 32;
  if (material >= design.materials.size() || depth > kMostNested) return;
  const Material& m = design.materials[material];
  for (const MaterialField& field : fieldsOf(m.type)) out.push_back({material, prefix, &field});
  if (m.a.valid()) collect(design, m.a.index, prefix, depth + 1, out);
  if (!m.b.valid()) return;
  const char* other = m.type == MaterialType::blend ? "second." : "back.";
  collect(design, m.b.index, prefix + other, depth + 1, out);
}

}  // namespace

std::vector<FieldPlace> fieldPlaces(const Design& design, uint32_t material) {
  std::vector<FieldPlace> places;
  collect(design, material, "", 0, places);
  return places;
}

FieldPlace findField(const Design& design, uint32_t material, const std::string& word,
                     const Location& where) {
  std::vector<std::string> words;
  for (FieldPlace& place : fieldPlaces(design, material)) {
    words.push_back(place.prefix + place.field->word);
    if (words.back() == word) return std::move(place);
  }
  if (words.empty())
    throw InputError(where, fmt::format("this material has nothing to set; change its type"));
  throw InputError(where, fmt::format("the material has no '{}'{}; it has {}", word,
                                      suggestion(word, words), fmt::join(words, ", ")));
}

FieldPlace findTexturable(const Design& design, uint32_t material, const std::string& word,
                          const Location& where) {
  FieldPlace place = findField(design, material, word, where);
  if (!place.field->texturable)
    throw InputError(where, fmt::format("{} cannot be a texture", place.field->word));
  return place;
}

Rgb fieldValue(const Material& m, const MaterialField& f) {
  switch (f.kind) {
    case FieldKind::color:
      return f.color != nullptr ? (m.*f.color).value : m.*f.plainColor;
    case FieldKind::scalar:
      return Rgb((m.*f.scalar).value);
    case FieldKind::number:
      return Rgb(m.*f.number);
    case FieldKind::flag:
      return Rgb(m.*f.flag ? 1.f : 0.f);
    case FieldKind::choice:
      return Rgb(
          static_cast<float>(f.index != nullptr ? m.*f.index : static_cast<int>(m.distribution)));
    case FieldKind::map:
      return {};
  }
  return {};
}

TextureHandle fieldTexture(const Material& m, const MaterialField& f) {
  if (f.color != nullptr) return (m.*f.color).texture;
  if (f.scalar != nullptr) return (m.*f.scalar).texture;
  return f.map != nullptr ? m.*f.map : TextureHandle{};
}

void setField(Material& m, const MaterialField& f, Rgb wanted) {
  Rgb value;
  for (int i = 0; i < 3; ++i)
    value[i] = wanted[i] >= f.least ? std::min(wanted[i], f.most) : f.least;  // of no number, too
  switch (f.kind) {
    case FieldKind::color:
      if (f.color != nullptr) {
        m.*f.color = value;
      } else {
        m.*f.plainColor = value;
      }
      break;
    case FieldKind::scalar:
      m.*f.scalar = value.x;
      if (f.also != nullptr) m.*f.also = value.x;
      break;
    case FieldKind::number:
      m.*f.number = value.x;
      break;
    case FieldKind::flag:
      m.*f.flag = value.x >= 0.5f;
      break;
    case FieldKind::choice:
      if (f.index != nullptr) {
        m.*f.index = static_cast<int>(value.x + 0.5f);
      } else {
        m.distribution = static_cast<Distribution>(value.x + 0.5f);
      }
      break;
    case FieldKind::map:
      break;
  }
}

void setFieldTexture(Material& m, const MaterialField& f, TextureHandle texture) {
  if (f.color != nullptr) (m.*f.color).texture = texture;
  if (f.scalar != nullptr) (m.*f.scalar).texture = texture;
  if (f.also != nullptr) (m.*f.also).texture = texture;
  if (f.map != nullptr) m.*f.map = texture;
}

}  // namespace lobelia::app
