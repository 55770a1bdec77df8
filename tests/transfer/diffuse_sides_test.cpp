// Which sides of vertices are kept apart, and how they are numbered.
#include "lobelia/transfer/diffuse_sides.h"

#include <gtest/gtest.h>

#include <array>
#include <stdexcept>

#include "transfer/simple_data.h"

namespace lobelia::transfer {
namespace {

TEST(DiffuseSides, FrontsAloneAreVertices) {
  const DiffuseSides sides;
  for (const size_t v : {0u, 1u, 77u}) {
    EXPECT_EQ(sides.find(v, Side::front), v);
    EXPECT_EQ(sides.find(v, Side::back), DiffuseSides::kNone);
  }
  EXPECT_EQ(sides.byteCount(), 0u);
  EXPECT_EQ(DiffuseSides(5, {}).byteCount(), 0u);
  EXPECT_EQ(DiffuseSides(5, {}).front(5), 5u);
}

TEST(DiffuseSides, BacksFollowTheirFronts) {
  const std::vector<uint32_t> backs{0, 2, 3};
  const DiffuseSides sides(5, backs);
  const std::array<size_t, 6> fronts{0, 2, 3, 5, 7, 8};
  for (size_t v = 0; v < 6; ++v) EXPECT_EQ(sides.front(v), fronts[v]) << v;
  for (const uint32_t v : backs) EXPECT_EQ(sides.find(v, Side::back), fronts[v] + 1);
  for (const uint32_t v : {1u, 4u}) EXPECT_EQ(sides.find(v, Side::back), DiffuseSides::kNone);
  EXPECT_EQ(sides.backs(), backs);
}

TEST(DiffuseSides, WantsVerticesThatAscend) {
  for (const auto& bad :
       {std::vector<uint32_t>{0, 5}, {2, 1}, {3, 3}, {0xffffffffu}, {4, 3, 2, 1, 0}})
    EXPECT_THROW(DiffuseSides(5, bad), std::invalid_argument);
  EXPECT_THROW(DiffuseSides(0, std::vector<uint32_t>{0}), std::invalid_argument);
  EXPECT_NO_THROW(DiffuseSides(5, std::vector<uint32_t>{0, 1, 2, 3, 4}));
}

// A square for each material; those whose four vertices are diffuse, and on which sides.
TEST(DiffuseSides, AreThoseOfMaterials) {
  Scene scene;
  const auto add = [&](Material m) { return test::addMaterial(scene, std::move(m)); };
  const auto both = [&](MaterialHandle front, MaterialHandle back) {
    Material m;
    m.type = MaterialType::twoSided;
    m.a = front, m.b = back;
    return add(m);
  };
  const MaterialHandle grey = add(test::phongMaterial({}, 10, Rgb(0.5f)));
  const MaterialHandle shiny = add(test::phongMaterial(Rgb(0.5f), 10));
  Material glass;
  glass.type = MaterialType::dielectric;
  Material thin;
  thin.type = MaterialType::diffuseTransmitter;
  thin.diffuse = Rgb(0.5f), thin.transmittance = Rgb(0.4f);
  const auto square = [&](MaterialHandle material) {
    test::addQuad(scene, {0, 0, 0}, {1, 0, 0}, {0, 1, 0}, material);
  };
  const auto found = [&] { return findDiffuse(scene, transferVertices(scene, splitMesh(scene))); };
  square(shiny), square(both(shiny, shiny)), square(add(glass));
  EXPECT_FALSE(found().any);
  EXPECT_TRUE(found().backs.empty());
  square(grey);
  EXPECT_TRUE(found().any);
  EXPECT_TRUE(found().backs.empty());
  square(both(grey, {})), square(both(grey, shiny)), square(both(shiny, grey)), square(add(thin));
  EXPECT_EQ(found().backs, (std::vector<uint32_t>{16, 17, 18, 19, 24, 25, 26, 27, 28, 29, 30, 31}));
  scene.instances.resize(1);
  scene.instances[0].material = both(shiny, grey);
  EXPECT_TRUE(found().any) << "behind alone";
}

}  // namespace
}  // namespace lobelia::transfer
