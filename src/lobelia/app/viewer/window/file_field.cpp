#include "lobelia/app/viewer/window/file_field.h"

#include <imgui.h>
#include <imgui_stdlib.h>

#include <algorithm>
#include <cctype>
#include <filesystem>
#include <vector>

namespace lobelia::app {
namespace {

namespace fs = std::filesystem;
constexpr size_t kMostListed = 2000;
constexpr float kRowsShown = 14;

bool endsAsOneOf(std::string name, std::span<const char* const> endings) {
  std::transform(name.begin(), name.end(), name.begin(),
                 [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  return std::any_of(endings.begin(), endings.end(),
                     [&](const char* ending) { return name.ends_with(ending); });
}

struct Listing {
  std::string folder;
  std::vector<std::string> folders, files;
};

// What cannot be read is empty. Hidden files are left out.
Listing list(const std::string& path, std::span<const char* const> endings) {
  Listing out;
  std::error_code ignored;
  fs::path folder = fs::is_directory(path, ignored) ? fs::path(path) : fs::path(path).parent_path();
  if (folder.empty()) folder = ".";
  out.folder = folder.string();
  for (fs::directory_iterator at(folder, fs::directory_options::skip_permission_denied, ignored),
       end;
       !ignored && at != end && out.folders.size() + out.files.size() < kMostListed;
       at.increment(ignored)) {
    const std::string name = at->path().filename().string();
    std::error_code unknown;
    if (name.starts_with('.')) continue;
    if (at->is_directory(unknown)) {
      out.folders.push_back(name);
    } else if (endsAsOneOf(name, endings)) {
      out.files.push_back(name);
    }
  }
  std::sort(out.folders.begin(), out.folders.end());
  std::sort(out.files.begin(), out.files.end());
  return out;
}

// The popup's rows. True when a file was chosen.
bool offer(Widgets& widgets, const Listing& listing, std::string& path, bool& again) {
  const auto join = [&](const std::string& name) {
    return (fs::path(listing.folder) / name).lexically_normal().string();
  };
  const auto enter = [&](const std::string& folder) {
    path = folder.ends_with('/') ? folder : folder + "/";
    again = true;
  };
  widgets.quiet(listing.folder);
  if (ImGui::Selectable("../", false, ImGuiSelectableFlags_DontClosePopups)) {
    std::error_code ignored;
    const fs::path whole = fs::absolute(listing.folder, ignored).lexically_normal();
    fs::path here = whole.has_filename() ? whole : whole.parent_path();  // without its last "/"
    enter(here.parent_path().string());
  }
  for (const std::string& folder : listing.folders)
    if (ImGui::Selectable((folder + "/").c_str(), false, ImGuiSelectableFlags_DontClosePopups))
      enter(join(folder));
  bool chosen = false;
  for (const std::string& file : listing.files)
    if (widgets.row(file, false)) {
      path = join(file);
      chosen = true;
    }
  if (listing.files.empty()) widgets.quiet("no such files here");
  return chosen;
}

}  // namespace

bool fileField(Widgets& widgets, const std::string& label, std::string& path,
               std::span<const char* const> endings) {
  static Listing listing;  // of the one popup that can be open; filled when it opens
  ImGui::PushID(label.c_str());
  ImGui::AlignTextToFramePadding();
  const float right = ImGui::GetFrameHeight() + ImGui::GetStyle().ItemSpacing.x;
  ImGui::SetNextItemWidth(-right);
  bool entered = ImGui::InputTextWithHint("##path", label.c_str(), &path,
                                          ImGuiInputTextFlags_EnterReturnsTrue);
  widgets.marks().note(label);
  widgets.hint(path.empty() ? label : label + ": " + path);
  ImGui::SameLine();
  if (ImGui::ArrowButton("list", ImGuiDir_Down)) {
    listing = list(path, endings);
    ImGui::OpenPopup("files");
  }
  widgets.marks().note(label + " list");
  ImGui::SetNextWindowSizeConstraints(
      ImVec2(14 * ImGui::GetFontSize(), 0),
      ImVec2(30 * ImGui::GetFontSize(), kRowsShown * ImGui::GetFrameHeightWithSpacing()));
  if (ImGui::BeginPopup("files")) {
    bool again = false;
    entered |= offer(widgets, listing, path, again);
    if (again) listing = list(path, endings);
    ImGui::EndPopup();
  }
  ImGui::PopID();
  return entered;
}

}  // namespace lobelia::app
