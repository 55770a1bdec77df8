// A small scene with what transfer knows apart: a glossy ground, a ball whose reflectance is driven
// by an image, and transfer of it that takes no time.
#pragma once

#include <gtest/gtest.h>

#include <algorithm>

#include "lobelia/transfer/precompute.h"
#include "relight/scenes.h"

namespace lobelia::test {

inline Material phongMaterial(Rgb diffuse, Rgb specular, float exponent) {
  Material m;
  m.type = MaterialType::phong;
  m.diffuse = diffuse, m.specular = specular, m.alphaU = exponent;
  return m;
}

// Instances: ground (cells x cells quads), ball. Materials: of the ground, of the ball.
inline Scene glossyScene(uint32_t cells = 3) {
  Scene scene;
  place(scene, groundMesh(cells));
  place(scene, sphereMesh(6, 4, true), translation({0, 0, 0.5}) * scaling({0.3, 0.3, 0.3}));
  scene.materials.clear();
  scene.images.push_back({"checks", 2, 1, 3, {0.2f, 0.4f, 0.6f, 0.7f, 0.5f, 0.3f}});
  Texture checks;
  checks.type = TextureType::bitmap;
  checks.image = {0};
  scene.textures.push_back(checks);
  scene.instances[0].material =
      addMaterial(scene, phongMaterial(Rgb(0.3f), Rgb(0.4f, 0.3f, 0.2f), 30));
  Material ball = phongMaterial(Rgb(0.2f), Rgb(0.f), 20);
  ball.specular = TextureHandle{0};
  scene.instances[1].material = addMaterial(scene, ball);
  return scene;
}

inline transfer::TransferSettings coarseTransfer() {
  transfer::TransferSettings settings;
  settings.directionLevel = 2, settings.rayLevel = 4, settings.maskLevel = 4;
  settings.subdivision = 1, settings.bounces = 1;
  return settings;
}

inline transfer::TransferData transferOf(const Scene& scene,
                                         const transfer::TransferSettings& settings,
                                         Context& context) {
  const Tracer tracer(scene, context);
  return transfer::precomputeTransfer(tracer, settings, context);
}

template <class A, class B>
bool sameItems(const A& a, const B& b) {
  return std::equal(a.begin(), a.end(), b.begin(), b.end());
}
inline bool sameRows(const transfer::SliceRows& a, const transfer::SliceRows& b) {
  return a.columnCount() == b.columnCount() && sameItems(a.bits(), b.bits()) &&
         sameItems(a.records(), b.records());
}

// Bit for bit.
inline void expectSame(const transfer::TransferData& a, const transfer::TransferData& b) {
  EXPECT_EQ(a.directionLevel, b.directionLevel);
  EXPECT_EQ(a.classCount, b.classCount);
  EXPECT_TRUE(sameItems(a.mesh.mesh.positions(), b.mesh.mesh.positions()));
  ASSERT_EQ(a.mesh.vertices.size(), b.mesh.vertices.size());
  for (size_t v = 0; v < a.mesh.vertices.size(); ++v) {
    const transfer::TransferVertex &left = a.mesh.vertices[v], &right = b.mesh.vertices[v];
    ASSERT_TRUE(left.instance == right.instance && left.triangle == right.triangle &&
                left.b1 == right.b1 && left.b2 == right.b2 && left.p == right.p &&
                left.n == right.n)
        << v;
  }
  EXPECT_EQ(a.mesh.buried, b.mesh.buried);
  EXPECT_EQ(a.diffuseSides.backs(), b.diffuseSides.backs());
  ASSERT_EQ(a.passes.size(), b.passes.size());
  for (size_t j = 0; j < a.passes.size(); ++j) {
    EXPECT_EQ(a.passes[j].diffuse, b.passes[j].diffuse) << j;
    ASSERT_EQ(a.passes[j].glossy.size(), b.passes[j].glossy.size()) << j;
    for (size_t c = 0; c < a.passes[j].glossy.size(); ++c)
      EXPECT_TRUE(sameRows(a.passes[j].glossy[c], b.passes[j].glossy[c])) << j << " " << c;
  }
  EXPECT_TRUE(sameRows(a.reflection, b.reflection));
}

}  // namespace lobelia::test
