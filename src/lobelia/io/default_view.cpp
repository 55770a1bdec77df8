// A view and light for scenes that have none: a camera that frames everything from the front, a
// little from the right and from above (or from the left or behind, where more of the outsides of
// surfaces shows; flat things, as charts and panels, straight), and the gradient of a
// photographer's studio.
#include "lobelia/io/default_view.h"

#include <fmt/format.h>

#include <cmath>
#include <span>

#include "lobelia/io/scene_io.h"

namespace lobelia::io {
namespace {

constexpr double kDegree = 3.14159265358979323846 / 180;
struct Place {
  double azimuth, elevation;  // about y from +z; above the floor
};
// Places of the camera, the first preferred.
constexpr Place kPlaces[] = {{30 * kDegree, 20 * kDegree},
                             {-30 * kDegree, 20 * kDegree},
                             {150 * kDegree, 20 * kDegree},
                             {-150 * kDegree, 20 * kDegree}};
constexpr Place kPlacesOfFlat[] = {{0, 4 * kDegree}, {180 * kDegree, 4 * kDegree}};
constexpr float kFlat = 0.2f;  // largest depth over the smaller of width and height
constexpr double kClearlyMore = 1.1;
constexpr double kFov = 35 * kDegree;
constexpr float kSmallest = 1e-30f, kLargest = 1e30f;  // radii that a camera can frame
constexpr double kMargin = 1.12;                       // of the film around what is framed
constexpr int kWidth = 1024, kHeight = 768;

// From where it is to look towards the centre. Made of a direction and a place: the two places are
// one point when the scene is far from the origin for its size.
Mat4 viewFrom(Vec3d place, Vec3d towards) {
  Mat4 toWorld = *lookAt({}, towards * -1.0, {0, 1, 0});
  toWorld.m[0][3] = place.x, toWorld.m[1][3] = place.y, toWorld.m[2][3] = place.z;
  return toWorld;
}

// Calls visit(p) with points that span what is framed, by `toView`: all vertices of the scene, or
// the corners of the box where the box is not the scene's.
template <class Visit>
void visitPoints(const Scene& scene, const Bounds3f& box, const Mat4& toView, Visit visit) {
  const Bounds3f all = bounds(scene);
  if (all.lo == box.lo && all.hi == box.hi) {
    for (const Instance& instance : scene.instances) {
      const Mat4 m = toView * instance.toWorld.to;
      for (const Vec3f p : scene[instance.mesh].positions) visit(m.point(p));
    }
    return;
  }
  for (int corner = 0; corner < 8; ++corner)
    visit(toView.point({corner & 1 ? box.hi.x : box.lo.x, corner & 2 ? box.hi.y : box.lo.y,
                        corner & 4 ? box.hi.z : box.lo.z}));
}

// Where, in the axes of a view towards the middle of the box, the camera has all points in the film
// and is as near as it can be.
Vec3d framingPlace(const Scene& scene, const Bounds3f& box, const Mat4& view) {
  const Mat4 toView = *inverse(view);
  Bounds3f seen;
  visitPoints(scene, box, toView, [&](Vec3f p) { seen.add(p); });
  const auto x = static_cast<double>(seen.centre().x), y = static_cast<double>(seen.centre().y);
  const double tanX = std::tan(kFov / 2) / kMargin, tanY = tanX * kHeight / kWidth;
  double distance = static_cast<double>(0.1f * box.radius() - seen.lo.z);  // in front of it all
  visitPoints(scene, box, toView, [&](Vec3f p) {
    const auto dx = std::abs(static_cast<double>(p.x) - x),
               dy = std::abs(static_cast<double>(p.y) - y);
    distance = std::max(distance, std::max(dx / tanX, dy / tanY) - static_cast<double>(p.z));
  });
  return {x, y, -distance};
}

// Area of all surfaces, projected along the view, whose outside faces the camera. The same from
// opposite sides for closed objects; of an open room, more is seen from its open side.
double facingArea(const Scene& scene, Vec3d towards) {
  double sum = 0;
  for (const Instance& instance : scene.instances) {
    const Mesh& mesh = scene[instance.mesh];
    const Vec3f local = normalize(instance.toWorld.inverted().vector(
        {static_cast<float>(towards.x), static_cast<float>(towards.y),
         static_cast<float>(towards.z)}));
    // The flow of a parallel light through a triangle scales by the determinant over the stretch
    // of its direction.
    const float stretch = length(instance.toWorld.vector(local));
    const double scale =
        std::abs(instance.toWorld.to.determinant3()) / static_cast<double>(stretch);
    double area = 0;
    for (const Vec3u t : mesh.triangles) {
      Vec3f n = cross(mesh.positions[t.y] - mesh.positions[t.x],
                      mesh.positions[t.z] - mesh.positions[t.x]);
      if (!mesh.normals.empty() &&
          dot(n, mesh.normals[t.x] + mesh.normals[t.y] + mesh.normals[t.z]) < 0)
        n = -n;
      area += static_cast<double>(std::max(0.f, dot(n, local)));
    }
    sum += area * scale;
  }
  return sum;
}

Vec3d viewDirection(const Scene& scene, const Bounds3f& box) {
  const Vec3f extent = box.extent();
  const bool flat = extent.z < kFlat * std::min(extent.x, extent.y);
  Vec3d best;
  double most = -1;
  for (const Place& p : flat ? std::span<const Place>(kPlacesOfFlat) : kPlaces) {
    const Vec3d towards(std::sin(p.azimuth) * std::cos(p.elevation), std::sin(p.elevation),
                        std::cos(p.azimuth) * std::cos(p.elevation));
    const double area = facingArea(scene, towards);
    if (most < 0 || area > most * kClearlyMore) best = towards, most = area;
  }
  return best;
}

// What is to be seen; a box of two units where the scene has no size, or one beyond all use.
Bounds3f framedBox(const Scene& scene) {
  const Bounds3f box = bounds(scene);
  const float radius = box.radius();
  if (!box.empty() && radius > kSmallest && radius < kLargest &&
      maxComponent(max(box.hi, -box.lo)) < kLargest)
    return box;
  const Vec3f centre = box.centre();
  const bool isPoint =
      !box.empty() && !(radius > kSmallest) && maxComponent(max(centre, -centre)) < kLargest;
  Bounds3f other;
  for (const float side : {-1.f, 1.f}) other.add((isPoint ? centre : Vec3f()) + Vec3f(side));
  return other;
}

Camera framingCamera(const Scene& scene) {
  const Bounds3f box = framedBox(scene);
  const Vec3f c = box.centre();
  const Vec3d centre(c.x, c.y, c.z);
  const Vec3d towards = viewDirection(scene, box);
  const Mat4 view = viewFrom(centre, towards);
  const Vec3d place = framingPlace(scene, box, view);
  const double distance = -place.z;
  Camera camera;
  camera.name = "default";
  camera.toWorld = Transform(view * translation(place));
  camera.fovX = static_cast<float>(kFov);
  camera.width = kWidth, camera.height = kHeight;
  const auto radius = static_cast<double>(box.radius());
  camera.nearClip = static_cast<float>(distance * 1e-3);
  camera.farClip = static_cast<float>((distance + radius) * 10);
  return camera;
}

// Radiance from a direction in the camera's space, x to the left: white walls that darken towards
// the floor, a large soft key light from the upper left behind the camera and a weaker one from the
// right that draws the edge.
float studioRadiance(Vec3f d) {
  const float height = 0.5f + 0.5f * d.y;
  const float walls = lerp(0.12f, 0.75f, height * height * (3 - 2 * height));
  const auto softLight = [&](Vec3f at, float sharpness, float radiance) {
    return radiance * std::exp(sharpness * (dot(d, normalize(at)) - 1));
  };
  return walls + softLight({0.7f, 0.75f, -0.6f}, 22, 7.f) +
         softLight({-0.9f, 0.5f, 0.5f}, 16, 2.5f);
}

// Mitsuba's axes: columns run about y, from -z by +x; the first and the last row are the poles.
Image studioImage() {
  Image image;
  image.name = "studio";
  image.width = 256, image.height = 128, image.channels = 3;
  for (int y = 0; y < image.height; ++y)
    for (int x = 0; x < image.width; ++x) {
      const float theta = kPi * static_cast<float>(y) / static_cast<float>(image.height - 1);
      const float phi = kTwoPi * (static_cast<float>(x) + 0.5f) / static_cast<float>(image.width);
      const Vec3f d{std::sin(phi) * std::sin(theta), std::cos(theta),
                    -std::cos(phi) * std::sin(theta)};
      const float value = studioRadiance(d);
      image.pixels.insert(image.pixels.end(), {value, value, value});
    }
  return image;
}

}  // namespace

void addStudio(Scene& scene, const std::string& why) {
  scene.images.push_back(studioImage());
  Emitter studio;
  studio.type = EmitterType::environment;
  studio.name = "studio";
  studio.image = {static_cast<uint32_t>(scene.images.size() - 1)};
  const Vec3f forward =
      scene.cameras.empty() ? Vec3f(0, 0, -1) : scene.cameras.front().toWorld.vector({0, 0, 1});
  const double angle = !isFinite(forward) ? 0
                                          : std::atan2(static_cast<double>(forward.x),
                                                       static_cast<double>(forward.z));
  studio.toWorld = Transform(rotation({0, 1, 0}, angle / kDegree));
  scene.emitters.push_back(studio);
  const std::string message = fmt::format(
      "{}; a neutral studio environment is added (--environment FILE lights the scene with "
      "another)",
      why);
  const Location where{scene.file, 0, 0};
  scene.findings.push_back({Severity::info, where, message});
}

void addDefaultView(Scene& scene) {
  const Location where{scene.file, 0, 0};
  if (scene.cameras.empty()) {
    scene.cameras.push_back(framingCamera(scene));
    scene.findings.push_back(
        {Severity::info, where, "there is no camera; one that frames everything is added"});
  }
  if (scene.emitters.empty()) addStudio(scene, "nothing shines");
}

}  // namespace lobelia::io
