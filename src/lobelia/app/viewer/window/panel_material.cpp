// The chosen material: all that material_fields.h knows of it, nothing by type.
#include <fmt/format.h>
#include <imgui.h>
#include <imgui_stdlib.h>

#include <algorithm>
#include <cctype>
#include <filesystem>

#include "lobelia/app/studio/material_edits.h"
#include "lobelia/app/studio/material_fields.h"
#include "lobelia/app/viewer/window/file_field.h"
#include "lobelia/app/viewer/window/panels.h"

namespace lobelia::app {
namespace {

constexpr float kListRows = 7;
constexpr const char* kMap = "map";

std::string materialName(const Design& design, uint32_t material) {
  const std::string& name = design.materials[material].name;
  return name.empty() ? fmt::format("material {}", material) : name;
}

bool contains(std::string text, std::string part) {
  const auto lower = [](std::string& s) {
    std::transform(s.begin(), s.end(), s.begin(),
                   [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  };
  lower(text);
  lower(part);
  return text.find(part) != std::string::npos;
}

// What other materials wrap is shown with these.
std::vector<bool> inner(const Design& design) {
  std::vector<bool> out(design.materials.size());
  for (const Material& m : design.materials)
    for (const MaterialHandle h : {m.a, m.b})
      if (h.valid() && h.index < out.size() && design.materials[h.index].name.empty())
        out[h.index] = true;
  return out;
}

void drawList(UiState& ui) {
  const Design& design = ui.studio.design();
  ImGui::SetNextItemWidth(-1);
  ImGui::InputTextWithHint("##filter", "filter", &ui.materialFilter);
  ui.marks.note("filter");
  const std::vector<bool> hidden = inner(design);
  ImGui::BeginChild("list", ImVec2(0, kListRows * ImGui::GetTextLineHeightWithSpacing()), true);
  for (uint32_t i = 0; i < design.materials.size(); ++i) {
    const std::string name = materialName(design, i);
    if (hidden[i] || !contains(name, ui.materialFilter)) continue;
    if (ui.widgets.row(fmt::format("{}##{}", name, i), i == ui.material)) {
      ui.material = i;
      ui.textureField.clear();
    }
  }
  ImGui::EndChild();
}

void drawType(UiState& ui) {
  const Design& design = ui.studio.design();
  const MaterialType now = design.materials[shownMaterial(design, ui.material)].type;
  std::vector<const char*> words;
  int at = -1;
  for (const MaterialType type : simpleTypes()) {
    if (type == now) at = static_cast<int>(words.size());
    words.push_back(typeWord(type));
  }
  const Touch touch = ui.widgets.choice("type", at, words);
  ui.edit(fmt::format("{}: type", materialName(design, ui.material)), touch,
          [&](Design& d) { changeType(d, ui.material, simpleTypes()[static_cast<size_t>(at)]); });
}

std::string textureName(const Design& design, TextureHandle texture) {
  const uint32_t image = design.textures[texture.index].image.index;
  if (image < design.sceneImages || image - design.sceneImages >= design.images.size())
    return "the scene's texture";
  return std::filesystem::path(design.images[image - design.sceneImages]->name).filename().string();
}

// A texture in place of the value, with a button that takes it away.
void drawTextured(UiState& ui, const FieldPlace& place, const std::string& label,
                  TextureHandle texture) {
  const Design& design = ui.studio.design();
  if (ui.widgets.withLabel(label, "x " + textureName(design, texture)))
    ui.edit(fmt::format("{}: {}", materialName(design, ui.material), label), {true, true},
            [&](Design& d) {
              setFieldTexture(d.materials[place.material], *place.field, TextureHandle());
            });
  ui.widgets.hint("take the texture away");
}

Touch drawValue(UiState& ui, const MaterialField& field, const std::string& label, Rgb& value) {
  switch (field.kind) {
    case FieldKind::color:
      return ui.widgets.color(label, value, field.most);
    case FieldKind::flag: {
      bool on = value.x != 0;
      const Touch touch = ui.widgets.checkBox(label, on);
      value.x = on ? 1 : 0;
      return touch;
    }
    case FieldKind::choice: {
      int chosen = static_cast<int>(value.x);
      const Touch touch = ui.widgets.choice(label, chosen, field.choices);
      value.x = static_cast<float>(chosen);
      return touch;
    }
    case FieldKind::scalar:
    case FieldKind::number:
      return ui.widgets.slider(label, value.x, field.least, field.most, field.logarithmic);
    case FieldKind::map:
      ui.widgets.quiet(label + ": none");
      return {};
  }
  return {};
}

// Makes a field the one that textures go to.
void drawTarget(UiState& ui, const std::string& label, const std::string& word) {
  const bool target = ui.textureField == word;
  if (target) ImGui::PushStyleColor(ImGuiCol_Button, ImGui::GetColorU32(ImGuiCol_SliderGrab));
  if (ImGui::Button(kMap)) ui.textureField = target ? "" : word;
  if (target) ImGui::PopStyleColor();
  ui.marks.note(label + " map");
  ui.widgets.hint("textures that are loaded or dropped go here");
}

void drawField(UiState& ui, const FieldPlace& place) {
  const Design& design = ui.studio.design();
  const Material& material = design.materials[place.material];
  const MaterialField& field = *place.field;
  const std::string label = place.prefix + field.label, word = place.prefix + field.word;
  ImGui::PushID(word.c_str());
  const float width = ImGui::CalcTextSize(kMap).x + 2 * ImGui::GetStyle().FramePadding.x;
  if (field.texturable) ui.widgets.leave(width + ImGui::GetStyle().ItemSpacing.x);
  const TextureHandle texture = fieldTexture(material, field);
  if (texture.valid()) {
    drawTextured(ui, place, label, texture);
  } else {
    Rgb value = fieldValue(material, field);
    const Touch touch = drawValue(ui, field, label, value);
    ui.edit(fmt::format("{}: {}", materialName(design, ui.material), label), touch,
            [&](Design& d) { setField(d.materials[place.material], field, value); });
  }
  ui.widgets.leave(0);
  if (field.texturable) {
    ImGui::SameLine();
    drawTarget(ui, label, word);
  }
  ImGui::PopID();
}

void drawTextureFile(UiState& ui) {
  if (ui.textureField.empty()) return;
  ui.widgets.quiet("texture for " + ui.textureField);
  if (fileField(ui.widgets, "texture file", ui.textureFile, kImageEndings) ||
      ui.widgets.button("load texture", !ui.textureFile.empty()))
    ui.studio.loadTexture(ui.textureFile, ui.material, ui.textureField);
}

void drawBump(UiState& ui) {
  if (!ImGui::TreeNode("bump and normal map")) {
    ui.marks.note("bump and normal map");
    return;
  }
  ui.marks.note("bump and normal map");
  fileField(ui.widgets, "bump file", ui.bumpFile, kImageEndings);
  ui.widgets.number("height", ui.bumpScale, -1e3f, 1e3f);
  ui.widgets.hint("of white above black, in the scene's units");
  const bool named = !ui.bumpFile.empty();
  if (ui.widgets.button("bump", named)) ui.studio.loadBump(ui.bumpFile, ui.material, ui.bumpScale);
  ImGui::SameLine();
  if (ui.widgets.button("normal map", named)) ui.studio.loadNormalMap(ui.bumpFile, ui.material);
  ImGui::SameLine();
  if (ui.widgets.button("none"))
    ui.edit(fmt::format("{}: no bump", materialName(ui.studio.design(), ui.material)), {true, true},
            [&](Design& d) { setBump(d, ui.material, TextureHandle(), 1); });
  ImGui::TreePop();
}

// With what it wraps. Materials that the scene has stand where they stood.
void restore(Design& design, const Design& first, uint32_t material) {
  if (material >= first.materials.size()) return;
  design.materials[material] = first.materials[material];
  for (const MaterialHandle h : {first.materials[material].a, first.materials[material].b})
    if (h.valid()) restore(design, first, h.index);
}

void resetMaterial(UiState& ui) {
  ui.edit(fmt::format("{}: as the scene has it", materialName(ui.studio.design(), ui.material)),
          {true, true}, [&](Design& d) { restore(d, ui.sceneDesign, ui.material); });
}

}  // namespace

void drawMaterialPanel(UiState& ui) {
  if (!ui.widgets.section("Material") || ui.studio.design().materials.empty()) return;
  ui.clampChoices();
  ImGui::PushID("material");
  drawList(ui);
  drawType(ui);
  // An edit may change what there is: the places are those of before it, one edit a frame.
  for (const FieldPlace& place : fieldPlaces(ui.studio.design(), ui.material)) {
    if (place.material >= ui.studio.design().materials.size()) break;
    drawField(ui, place);
  }
  drawTextureFile(ui);
  drawBump(ui);
  if (ui.widgets.button("as the scene has it")) resetMaterial(ui);
  ImGui::PopID();
}

}  // namespace lobelia::app
