// docs/gallery.md: every built-in scene, its picture and the command that makes it. scripts/gallery
// runs the commands that it finds there.
#include <fmt/format.h>

#include <string_view>

#include "lobelia/app/docs/writers.h"
#include "lobelia/builtin/builtin_scenes.h"

namespace lobelia::app {
namespace {

constexpr std::string_view kStudyPrefix = "study-";

// "[P000]" names a paper whose scene this one is after; the gallery leaves it out.
std::string withoutCitation(std::string_view description) {
  return std::string(description.substr(0, description.find(" [")));
}

// To the nearest thousand, as tessellation differs by detail anyway.
std::string roughly(uint64_t triangles) { return fmt::format("{},000", (triangles + 500) / 1000); }

// The Cornell box is square; the other scenes' cameras are made for 4:3.
const char* size(std::string_view name) { return name == "cornell" ? "360x360" : "480x360"; }

}  // namespace

std::string gallery() {
  std::string pictures, studies;
  for (const builtin::BuiltinScene& scene : builtin::builtinScenes()) {
    const std::string_view name = scene.name;
    if (name.starts_with(kStudyPrefix)) {
      studies += fmt::format("{}`{}`", studies.empty() ? "" : ", ", name);
      continue;
    }
    pictures += fmt::format(
        "\n## {0}\n\n{1}; about {2} triangles.\n\n![{1}](gallery/{0}.jpg)\n\n"
        "    lobelia render {0} --size {3} --spp 64 --num-lights 256 -o {0}.png\n",
        name, withoutCitation(scene.description), roughly(scene.triangles), size(name));
  }
  return fmt::format(
      "# Gallery\n\n"
      "The built-in scenes, each with the command that made its picture. `scripts/gallery` renders "
      "them and\nwrites this page from the program's table of scenes (`lobelia docs gallery`). "
      "`--detail`, `--camera`,\n`--sky` and `--meshes` change them: see [options.md](options.md).\n"
      "{}\n## Studies\n\nFor measurements, not for looking at: {}.\n",
      pictures, studies);
}

}  // namespace lobelia::app
