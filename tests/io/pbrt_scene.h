// For the tests of the PBRT reader: scenes given as text.
#pragma once

#include "io/temporary_folder.h"
#include "lobelia/io/scene_io.h"

namespace lobelia::test {

inline Scene readPbrtText(const TemporaryFolder& folder, const std::string& text,
                          const io::ReadSettings& settings = {}) {
  Context context;
  return io::readPbrt(folder.write("scene.pbrt", text), settings, context);
}
// The text behind WorldBegin, which is in line 2.
inline Scene readPbrtWorld(const std::string& body, const io::ReadSettings& settings = {}) {
  const TemporaryFolder folder;
  return readPbrtText(folder, "Camera \"perspective\"\nWorldBegin\n" + body + "\n", settings);
}
inline std::string pbrtRefusal(const std::string& body) {
  return messageOf<InputError>([&] { readPbrtWorld(body); });
}
inline std::string findingsOf(const Scene& scene) {
  std::string out;
  for (const Finding& f : scene.findings) out += f.message + "\n";
  return out;
}
// The only shape's material without the wrapper for both sides.
inline const Material& onlyMaterial(const Scene& scene) {
  const Material& m = scene[scene.instances.at(0).material];
  return m.type == MaterialType::twoSided ? scene[m.a] : m;
}
inline Rgb colorOf(const Emitter& e) { return e.radiance.value; }

inline constexpr const char* kTriangle =
    "Shape \"trianglemesh\" \"point3 P\" [0 0 0 1 0 0 0 1 0]\n";

inline void expectNear(Vec3f a, Vec3f b, float tolerance = 1e-4f) {
  for (int i = 0; i < 3; ++i) EXPECT_NEAR(a[i], b[i], tolerance) << i;
}

}  // namespace lobelia::test
