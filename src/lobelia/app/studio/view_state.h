// How a design is looked at: the camera, the method, the size. No part of the design and of no
// history; any of it may change at any time.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "lobelia/app/render_options.h"
#include "lobelia/scene/camera.h"

namespace lobelia::app {

// cuts: cut_frames.h, direct light from infinity, local light and one bounce of it; transfer:
// transfer_frames.h, light from infinity with its reflections. Both in one go, from data of
// `precompute`; the others are those of `render`, pass by pass.
enum class ViewMethod : uint8_t { cuts, transfer, path, sglc, vsl, vsgl };
const std::vector<std::string>& viewMethodNames();  // in that order
std::optional<ViewMethod> viewMethod(const std::string& name);
inline bool inOneGo(ViewMethod method) {
  return method == ViewMethod::cuts || method == ViewMethod::transfer;
}

struct ViewState {
  Camera camera;              // its film's size is left alone: the two below say the picture's
  int width = 0, height = 0;  // pixels; 0: nothing is drawn
  bool cropped = false;       // the camera's crop counts, which must lie within
  ViewMethod method = ViewMethod::cuts;
  size_t lightCut = 512;          // cuts: nodes of the light's cut, at most
  bool refined = true;            // cuts: finer light where lobes are narrow
  int frameSpp = 1;               // cuts, transfer: samples per pixel
  int areaPlaces = 4;             // cuts: of each area emitter, for shadow rays
  std::string component = "all";  // cuts, transfer: or "direct", "indirect"
  int bounce = -1;                // transfer: light of so many bounces alone; -1: all
  int spp = 256;                  // progressive: samples per pixel after which a picture is done
  uint64_t lightCount = 0;        // sglc, vsl, vsgl: virtual lights of a pass; 0: a quick number
  int maxDepth = 0;               // progressive; 0: the scene's
  int cutsDepth = 2;              // of the light that cuts show; 3 with data of local lights
  int transferDepth = 2;          // of the light that transfer shows
  bool truth = false;             // the path-traced truth converges in the background
  bool cost = false;              // pictures have the layer "cost"
  // Surfaces are white, so that the picture times pi is the irradiance (false_color.h).
  bool white = false;
};

// The film that the camera has in this view.
Camera viewCamera(const ViewState& view);
// Of the light that the method shows, as `render --max-depth` counts.
int depthOf(const ViewState& view);

// What part of light the method's pictures have alone, in words; "": all of it.
std::string partOf(const ViewState& view);

// What `render` would be told for a pass of so many samples per pixel. method: not in one go.
RenderOptions passOptions(const ViewState& view, ViewMethod method, int spp);

// Do rays through the films of two cameras run alike? The films' sizes do not count.
bool sameRays(const Camera& a, const Camera& b);
// Do two views show other pictures? Of the truth, of the method's own.
bool samePicture(const ViewState& a, const ViewState& b);
bool sameTruth(const ViewState& a, const ViewState& b);

}  // namespace lobelia::app
