// Virtual lights in trees with bounds, one tree per class [P000 section 4.1], with what stands for
// a node: a light of the class with the power of all.
//
// Past the paper, which has no spherical lights: their nodes have bounds of the light that leaves
// all of their spheres, and one of them, drawn by power, stands for all, scaled.
#pragma once

#include "lobelia/gather/light_choice.h"
#include "lobelia/gather/sphere.h"
#include "lobelia/trees/bound_tree.h"

namespace lobelia::gather {

struct LightForest {
  struct Tree {
    LightClass lightClass = LightClass::omni;
    // Lights that no other stands for: omni lights with a pattern of directions. Their bounds do
    // not hold, either.
    bool apart = false;
    uint16_t group = 0;  // of all its lights: those of different light groups are never merged
    trees::BoundTree tree;
    std::vector<uint32_t> lights;  // index in the class, by place of the leaves' order
    // By node: sums of intensities, of spherical lights of powers; of Gaussians their integrals.
    std::vector<Rgb> power;
  };
  std::vector<Tree> trees;  // none is empty
};

// A light as trees of bounds have it: luminances. sphere: of spherical lights.
trees::BoundItem boundItemOf(const VirtualLights& lights, LightClass lightClass, size_t index,
                             const PreparedSphere* sphere);
// Of a light, as LightForest::Tree::power counts it.
Rgb lightPower(const VirtualLights& lights, LightClass lightClass, size_t index);

// Lights that receivers of this depth gather. bounds: of the scene. prepared: prepareLights(). The
// same for any number of threads.
LightForest plantLights(const VirtualLights& lights, const GatherSettings& settings,
                        int receiverDepth, const Scene& scene, const Bounds3f& bounds,
                        const PreparedLights& prepared);

// What stands for nodes of a tree, at most kBlockLights of them, as a block to be shaded. A leaf's
// light is itself, with its index. prepared: must outlive the block.
void prepareNodes(const VirtualLights& lights, const Scene& scene, const LightForest::Tree& tree,
                  std::span<const uint32_t> nodes, const PreparedLights& prepared,
                  LightBlock* block);

// A light of a node, drawn by its share of the node's power (luminances) with a random number:
// whence its shadow ray comes.
uint32_t lightOf(const LightForest::Tree& tree, uint32_t node, uint64_t key);

}  // namespace lobelia::gather
