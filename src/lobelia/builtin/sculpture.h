// Sculptures: bodies blended from simple parts as a signed distance, polygonised (internal to this
// room). They stand in for the scanned models of the papers' scenes.
//
// Parts are joined in the order in which they are added by a union that is rounded over a width
// (the quadratic polynomial smooth minimum: exact where the distances differ by more than the
// width, so that a part has no influence beyond it). y is up.
#pragma once

#include <optional>
#include <vector>

#include "lobelia/base/frame.h"
#include "lobelia/base/transform.h"
#include "lobelia/scene/mesh.h"

namespace lobelia::builtin {

// A relief of overlapping scales around a round cone: rows run along it. Row numbers at its ends
// (so that a chain of cones continues the pattern), scales around it, their height.
struct Scales {
  float rowFrom = 0, rowTo = 0;
  int around = 0;
  float height = 0;
};

struct Part {
  enum class Shape : uint8_t { cone, ellipsoid, sheet };
  Shape shape = Shape::cone;
  Vec3f a, b, c;         // cone: ends; ellipsoid: centre a, radii b; sheet: triangle
  float ra = 0, rb = 0;  // cone: radii at the ends; sheet: half thickness ra
  Frame frame;           // ellipsoid: its axes; cone: s is where the pattern starts, n its axis
  float blend = 0;       // width over which it is joined to what is there
  bool carved = false;   // taken away instead of added
  Scales scales;
  float distance(Vec3f p) const;
};

class Sculpture {
 public:
  Part& cone(Vec3f a, Vec3f b, float ra, float rb, float blend);  // between two balls
  Part& ball(Vec3f centre, float radius, float blend);
  // Turned by the given degrees about z, then y, then x.
  Part& ellipsoid(Vec3f centre, Vec3f radii, float blend, Vec3f turn = {});
  Part& sheet(Vec3f a, Vec3f b, Vec3f c, float thickness, float blend);
  // A chain of cones through points (smooth curve), `steps` of them per point, with radii between
  // the given ones; with scales of that height, `around` around it, when height > 0.
  void chain(const std::vector<Vec3f>& points, const std::vector<float>& radii, int steps,
             float blend, int around = 0, float height = 0);
  // Everything added since `first` again on the other side of 0 along the axis.
  void mirror(size_t first, int axis);
  size_t partCount() const { return parts_.size(); }
  // Cuts everything below this height off.
  void standOn(float height) { floor_ = height; }

  // Triangles by naive surface nets (S. Gibson, "Constrained Elastic Surface Nets", MICCAI 1998,
  // without its relaxation), `cells` along the longest side of the sculpture; normals are the
  // gradient of the distance. Same result for any number of threads.
  Mesh mesh(int cells) const;

 private:
  // Distance from these of the parts, by index.
  float distance(Vec3f p, const std::vector<uint32_t>& parts) const;
  std::vector<Part> parts_;
  std::optional<float> floor_;
  friend class SurfaceNets;
};

}  // namespace lobelia::builtin
