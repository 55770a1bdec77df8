// Cameras: plain data and ray generation.
#pragma once

#include <string>
#include <vector>

#include "lobelia/base/transform.h"

namespace lobelia {

struct Ray {
  Vec3f o, d;  // d unit
  float tMin = 0, tMax = 3.4e38f;
};

enum class CameraType : uint8_t { perspective, orthographic };
enum class PixelFilter : uint8_t { box, tent, gaussian, mitchell, catmullRom, lanczos };

// A camera's place at a time, for camera paths.
struct CameraKey {
  float time = 0;  // seconds
  Transform toWorld;
};

struct Camera {
  std::string name;
  CameraType type = CameraType::perspective;
  Transform toWorld;             // looks along +z, x to the left (Mitsuba)
  float fovX = 0.7f;             // horizontal field of view in radians, after fov_axis was resolved
  Vec2f principalPointOffset{};  // in units of the film's size, Mitsuba's sign
  float nearClip = 1e-2f, farClip = 1e4f;
  float apertureRadius = 0, focusDistance = 0;         // thin lens when the radius is > 0
  int width = 768, height = 576;                       // full film
  int cropX0 = 0, cropY0 = 0, cropX1 = 0, cropY1 = 0;  // data window; x1 == 0: the whole film
  PixelFilter filter = PixelFilter::gaussian;
  float filterRadius = 0;  // 0: the filter's default
  int spp = 0;             // hint of the scene file, 0: none
  std::vector<CameraKey> path;  // by time; empty: it stands still at toWorld
};

// Ray through a film position (pixels, (0,0) the top left corner of the full film).
Ray generateRay(const Camera& camera, Vec2f film, Vec2f uLens);
// For light tracing. Where on the film does a world point appear? weight: importance W_e(p) times
// the geometry that turns flux at `point` with cosine taken separately into the pixel value; empty
// when outside the film. lens: point on the lens that was connected to.
struct FilmConnection {
  Vec2f film;
  Vec3f lens;
  float importance;
};
bool connectToCamera(const Camera& camera, Vec3f point, Vec2f uLens, FilmConnection* out);
// Offset in pixels from the pixel centre drawn from the reconstruction filter; *weight is +-1
// times the normalisation (filter importance sampling, Ernst et al. 2006).
// The mean of weight times radiance is the filtered pixel. radius 0: the filter's default.
Vec2f sampleFilter(PixelFilter filter, float radius, Vec2f u, float* weight);
// The filter along one axis at x pixels from its centre, not normalised. Gaussian: the standard
// deviation is a quarter of the radius, shifted down to 0 there; Lanczos: as many lobes as the
// radius.
float evaluateFilter(PixelFilter filter, float radius, float x);
float defaultRadius(PixelFilter filter);

}  // namespace lobelia
