#include "lobelia/app/viewer/window/notes.h"

#include <fmt/format.h>
#include <imgui.h>

#include <algorithm>

namespace lobelia::app {
namespace {

double secondsSince(int64_t then) { return static_cast<double>(nanosecondsNow() - then) * 1e-9; }

ImVec4 colorOf(Severity severity) {
  switch (severity) {
    case Severity::error:
      return {0.95f, 0.45f, 0.40f, 1};
    case Severity::warning:
      return {0.95f, 0.78f, 0.40f, 1};
    default:
      return ImGui::GetStyleColorVec4(ImGuiCol_Text);
  }
}

}  // namespace

void Notes::add(Severity severity, const std::string& text) {
  // Said again (a slider dragged through what is refused): once, and how often.
  const auto same = std::find_if(notes_.begin(), notes_.end(), [&](const Note& n) {
    return n.severity == severity && n.text == text;
  });
  if (same != notes_.end()) {
    ++same->times;
    same->since = nanosecondsNow();
    return;
  }
  notes_.push_back({severity, text, nanosecondsNow(), 1, nextNumber_++});
  if (notes_.size() > kMostKept) notes_.pop_front();
}

bool Notes::says(const std::string& text) const {
  return std::any_of(notes_.begin(), notes_.end(),
                     [&](const Note& n) { return n.text.find(text) != std::string::npos; });
}

bool Notes::passing() const {
  return std::any_of(notes_.begin(), notes_.end(),
                     [](const Note& n) { return n.severity < Severity::warning; });
}

void Notes::forgetOld() {
  std::erase_if(notes_, [](const Note& n) {
    return n.severity < Severity::warning && secondsSince(n.since) > kSeconds;
  });
}

bool Notes::drawOne(const Note& note, float width, Marks& marks) const {
  ImGui::PushID(note.number);
  const bool dismissed = ImGui::SmallButton("x");
  marks.note("dismiss");
  ImGui::SameLine();
  ImGui::PushTextWrapPos(width);
  ImGui::PushStyleColor(ImGuiCol_Text, colorOf(note.severity));
  const std::string times = note.times > 1 ? fmt::format(" ({} times)", note.times) : "";
  ImGui::TextUnformatted((note.text + times).c_str());
  ImGui::PopStyleColor();
  ImGui::PopTextWrapPos();
  ImGui::PopID();
  return dismissed;
}

void Notes::draw(const MarkedBox& box, Marks& marks) {
  forgetOld();
  if (notes_.empty()) return;
  const float margin = ImGui::GetStyle().ItemSpacing.x, most = 46 * ImGui::GetFontSize();
  const float width = std::min(box.hi.x - box.lo.x - 2 * margin, most);
  if (width < 4 * ImGui::GetFontSize()) return;
  ImGui::SetNextWindowPos(ImVec2(box.lo.x + margin, box.hi.y - margin), ImGuiCond_Always,
                          ImVec2(0, 1));
  ImGui::SetNextWindowSizeConstraints(ImVec2(width, 0), ImVec2(width, box.hi.y - box.lo.y));
  ImGui::SetNextWindowBgAlpha(0.88f);
  marks.setPanel("Notes");
  if (ImGui::Begin("##notes", nullptr,
                   ImGuiWindowFlags_NoDecoration | ImGuiWindowFlags_AlwaysAutoResize |
                       ImGuiWindowFlags_NoFocusOnAppearing | ImGuiWindowFlags_NoNav |
                       ImGuiWindowFlags_NoMove | ImGuiWindowFlags_NoSavedSettings)) {
    const size_t shown = std::min(notes_.size(), kMostShown);
    int dismissed = -1;
    for (size_t i = notes_.size() - shown; i < notes_.size(); ++i)
      if (drawOne(notes_[i], width - margin, marks)) dismissed = notes_[i].number;
    if (notes_.size() > shown) {
      ImGui::TextDisabled("%zu more", notes_.size() - shown);
      ImGui::SameLine();
      if (ImGui::SmallButton("dismiss all")) notes_.clear();
      marks.note("dismiss all");
    }
    std::erase_if(notes_, [&](const Note& n) { return n.number == dismissed; });
  }
  ImGui::End();
}

}  // namespace lobelia::app
