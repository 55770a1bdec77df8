#include "lobelia/app/studio/view_state.h"

#include <fmt/format.h>

#include <algorithm>

namespace lobelia::app {

bool sameRays(const Camera& a, const Camera& b) {
  return a.type == b.type && a.toWorld.to == b.toWorld.to && a.fovX == b.fovX &&
         a.principalPointOffset == b.principalPointOffset && a.nearClip == b.nearClip &&
         a.farClip == b.farClip && a.apertureRadius == b.apertureRadius &&
         a.focusDistance == b.focusDistance && a.filter == b.filter &&
         a.filterRadius == b.filterRadius;
}

const std::vector<std::string>& viewMethodNames() {
  static const std::vector<std::string> names{"cuts", "transfer", "path", "sglc", "vsl", "vsgl"};
  return names;
}

std::optional<ViewMethod> viewMethod(const std::string& name) {
  const auto& names = viewMethodNames();
  const auto at = std::find(names.begin(), names.end(), name);
  if (at == names.end()) return {};
  return static_cast<ViewMethod>(at - names.begin());
}

Camera viewCamera(const ViewState& view) {
  Camera camera = view.camera;
  camera.width = view.width, camera.height = view.height;
  if (!view.cropped) {
    camera.cropX0 = camera.cropY0 = 0;
    camera.cropX1 = view.width, camera.cropY1 = view.height;
  }
  camera.path.clear();
  return camera;
}

int depthOf(const ViewState& view) {
  constexpr int kDirect = 2;
  if (view.white) return kDirect;
  if (view.method == ViewMethod::transfer) return view.transferDepth;
  return view.method == ViewMethod::cuts ? view.cutsDepth : view.maxDepth;
}

std::string partOf(const ViewState& view) {
  if (!inOneGo(view.method)) return "";
  if (view.method == ViewMethod::transfer && view.bounce >= 0)
    return fmt::format("light of bounce {}", view.bounce);
  return view.component == "all" ? "" : view.component + " light";
}

RenderOptions passOptions(const ViewState& view, ViewMethod method, int spp) {
  RenderOptions options;
  options.spp = spp;
  options.maxDepth = depthOf(view);
  options.lightCount = view.lightCount;
  if (view.cost) options.aovs = "cost";
  // As few as a pass of some tenths of a second allows; passes have lights of their own.
  const auto quick = [&](uint64_t count) {
    if (view.lightCount == 0) options.lightCount = count;
  };
  switch (method) {
    case ViewMethod::cuts:
    case ViewMethod::transfer:
    case ViewMethod::path:
      options.lights = "path";
      break;
    case ViewMethod::sglc:
      options.lights = "glossy", options.gather = "sglc";
      quick(50'000);
      break;
    case ViewMethod::vsl:
      options.lights = "vsl", options.gather = "mrcs";
      quick(20'000);
      break;
    case ViewMethod::vsgl:
      options.lights = "vsgl", options.gather = "all";
      quick(1000);
      break;
  }
  return options;
}

bool samePicture(const ViewState& a, const ViewState& b) {
  return sameRays(a.camera, b.camera) && a.width == b.width && a.height == b.height &&
         a.method == b.method && a.lightCut == b.lightCut && a.refined == b.refined &&
         a.frameSpp == b.frameSpp && a.bounce == b.bounce && a.areaPlaces == b.areaPlaces &&
         a.component == b.component && a.cropped == b.cropped && a.lightCount == b.lightCount &&
         a.maxDepth == b.maxDepth && a.cost == b.cost && a.white == b.white;
}

bool sameTruth(const ViewState& a, const ViewState& b) {
  return sameRays(a.camera, b.camera) && a.width == b.width && a.height == b.height &&
         depthOf(a) == depthOf(b) && a.white == b.white;
}

}  // namespace lobelia::app
