// Light trees as tables, for research: nodes in preorder with what strategies know of them, and the
// lights in the leaves' order.
#pragma once

#include "lobelia/gather/export_table.h"
#include "lobelia/gather/light_forest.h"
#include "lobelia/trees/light_tree.h"

namespace lobelia::gather {

struct ExportedTree {
  std::string meaning;
  ExportTable nodes, lights;
};

// A tree of estimates (trees/light_tree.h). numbers: of its lights.
ExportedTree exportTree(const trees::LightTree& tree, const LightNumbers& numbers,
                        const VirtualLights& lights, const std::string& meaning);
// A tree of bounds (trees/bound_tree.h).
ExportedTree exportTree(const LightForest::Tree& tree, const VirtualLights& lights);

}  // namespace lobelia::gather
