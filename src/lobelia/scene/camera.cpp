// Rays of cameras, and the connection of a world point to the film.
//
// Conventions are Mitsuba 3's sensors perspective, thinlens and orthographic: camera space looks
// along +z with x to the left and y up; the film's x spans the horizontal field of view, [-1, 1] on
// the plane z = 1 times tan(fov / 2), or [-1, 1] itself when orthographic; its y the same over the
// aspect ratio. The principal point offset moves the film position, in units of the full film.
// Near and far clip are distances along z in camera space. Deviation: Mitsuba refuses a scaling
// toWorld for a perspective camera; here it scales the clip distances and the lens too.
//
// Importance. A pixel's value is the mean over pixel and lens of the radiance that arrives. With x
// on the plane z = 1 seen from a point of the lens, dx = dw / cos^3, and a surface at distance d
// has dw = cos_p dA / d^2, so light tracing adds
//     flux * f * cos_p * 1 / (A_pixel cos^3 d^2) / (number of paths)
// to the pixel, where A_pixel is the area of one pixel on that plane. The same holds from every
// point of a lens (the plane in focus is a scaled copy), which is drawn uniformly. Orthographic
// cameras see parallel light: the term is 1 / A_pixel with the pixel's area across the view
// direction in the world.
#include "lobelia/scene/camera.h"

#include <cmath>

#include "lobelia/base/sampling.h"

namespace lobelia {
namespace {

// Half the film's extent in x on the plane z = 1 (perspective).
float halfWidth(const Camera& c) {
  return c.type == CameraType::perspective ? std::tan(0.5f * c.fovX) : 1.f;
}
float aspect(const Camera& c) { return static_cast<float>(c.width) / static_cast<float>(c.height); }

// Film position in pixels <-> position on the film plane of camera space.
Vec2f filmToPlane(const Camera& c, Vec2f film) {
  const float u = film.x / static_cast<float>(c.width) + c.principalPointOffset.x;
  const float v = film.y / static_cast<float>(c.height) + c.principalPointOffset.y;
  const float h = halfWidth(c);
  return {(1 - 2 * u) * h, (1 - 2 * v) * h / aspect(c)};
}
Vec2f planeToFilm(const Camera& c, Vec2f plane) {
  const float h = halfWidth(c);
  const float u = 0.5f * (1 - plane.x / h) - c.principalPointOffset.x;
  const float v = 0.5f * (1 - plane.y * aspect(c) / h) - c.principalPointOffset.y;
  return {u * static_cast<float>(c.width), v * static_cast<float>(c.height)};
}

Vec3f lensPoint(const Camera& c, Vec2f uLens) {
  if (c.apertureRadius <= 0) return {};
  const Vec2f d = sampleDiskConcentric(uLens) * c.apertureRadius;
  return {d.x, d.y, 0};
}

Ray perspectiveRay(const Camera& c, Vec2f film, Vec2f uLens) {
  const Vec2f plane = filmToPlane(c, film);
  const Vec3f lens = lensPoint(c, uLens);
  Vec3f d{plane.x, plane.y, 1};
  if (c.apertureRadius > 0) d = d * c.focusDistance - lens;
  d = normalize(d);
  const Vec3f world = c.toWorld.vector(d);
  const float scale = length(world);
  return {c.toWorld.point(lens), world / scale, c.nearClip / d.z * scale, c.farClip / d.z * scale};
}

// Mitsuba starts at the near plane and measures the far plane along the unit direction.
Ray orthographicRay(const Camera& c, Vec2f film) {
  const Vec2f plane = filmToPlane(c, film);
  return {c.toWorld.point({plane.x, plane.y, c.nearClip}), normalize(c.toWorld.vector({0, 0, 1})),
          0, c.farClip - c.nearClip};
}

bool insideFilm(const Camera& c, Vec2f film) {
  return film.x >= 0 && film.x < static_cast<float>(c.width) && film.y >= 0 &&
         film.y < static_cast<float>(c.height);
}

bool connectPerspective(const Camera& c, Vec3f point, Vec2f uLens, FilmConnection* out) {
  const Vec3f local = c.toWorld.from.point(point);
  if (!(local.z >= c.nearClip && local.z <= c.farClip)) return false;
  const Vec3f lens = lensPoint(c, uLens);
  const Vec3f d = local - lens;
  // Where the line from the lens meets the plane in focus, seen from the lens' centre.
  Vec2f plane{d.x / d.z, d.y / d.z};
  if (c.apertureRadius > 0) plane = plane + Vec2f{lens.x, lens.y} * (1 / c.focusDistance);
  out->film = planeToFilm(c, plane);
  if (!insideFilm(c, out->film)) return false;
  out->lens = c.toWorld.point(lens);
  const float h = halfWidth(c);
  const float pixelWidth = 2 * h / static_cast<float>(c.width);
  const float pixelArea = pixelWidth * pixelWidth;  // pixels are square: see filmToPlane
  const float inverseCos = length(d) / d.z;
  out->importance =
      inverseCos * inverseCos * inverseCos / (pixelArea * lengthSquared(point - out->lens));
  return std::isfinite(out->importance);
}

bool connectOrthographic(const Camera& c, Vec3f point, FilmConnection* out) {
  const Vec3f local = c.toWorld.from.point(point);
  out->film = planeToFilm(c, {local.x, local.y});
  if (!insideFilm(c, out->film)) return false;
  out->lens = c.toWorld.point({local.x, local.y, c.nearClip});
  const Vec3f axis = normalize(c.toWorld.vector({0, 0, 1}));
  const float depth = dot(point - out->lens, axis);
  if (!(depth > 0 && depth <= c.farClip - c.nearClip)) return false;
  const float pixel = 2 / static_cast<float>(c.width);
  const Vec3f x = c.toWorld.vector({pixel, 0, 0}), y = c.toWorld.vector({0, pixel, 0});
  out->importance = 1 / std::abs(dot(cross(x, y), axis));
  return std::isfinite(out->importance);
}

}  // namespace

Ray generateRay(const Camera& camera, Vec2f film, Vec2f uLens) {
  return camera.type == CameraType::perspective ? perspectiveRay(camera, film, uLens)
                                                : orthographicRay(camera, film);
}

bool connectToCamera(const Camera& camera, Vec3f point, Vec2f uLens, FilmConnection* out) {
  return camera.type == CameraType::perspective ? connectPerspective(camera, point, uLens, out)
                                                : connectOrthographic(camera, point, out);
}

}  // namespace lobelia
