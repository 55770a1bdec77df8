#include "lobelia/app/viewer/window/marks.h"

#include <imgui.h>

#include <algorithm>
#include <utility>

namespace lobelia::app {

void Marks::beginFrame() {
  before_ = std::exchange(now_, {});
  panel_.clear();
}

bool Marks::is(const std::string& path, const std::string& label) const {
  if (path == label) return true;
  return path.size() > label.size() && path.ends_with(label) &&
         path[path.size() - label.size() - 1] == '/';
}

void Marks::note(const std::string& label) {
  const ImVec2 lo = ImGui::GetItemRectMin(), hi = ImGui::GetItemRectMax();
  // Half of it in sight: a click on its middle reaches it.
  const ImVec2 middle((lo.x + hi.x) / 2, (lo.y + hi.y) / 2);
  const bool visible =
      ImGui::IsRectVisible(ImVec2(middle.x - 1, middle.y - 1), ImVec2(middle.x + 1, middle.y + 1));
  const std::string path = panel_ + "/" + label;
  now_.insert_or_assign(path, MarkedBox{{lo.x, lo.y}, {hi.x, hi.y}, visible});
  if (!sought_.empty() && !visible && is(path, sought_)) ImGui::SetScrollHereY(0.5f);
}

std::optional<MarkedBox> Marks::find(const std::string& label) const {
  for (const auto* boxes : {&now_, &before_})
    for (const auto& [path, box] : *boxes)
      if (is(path, label)) return box;
  return std::nullopt;
}

std::vector<std::string> Marks::labels() const {
  std::vector<std::string> out;
  for (const auto& [path, box] : before_.empty() ? now_ : before_) out.push_back(path);
  return out;
}

}  // namespace lobelia::app
