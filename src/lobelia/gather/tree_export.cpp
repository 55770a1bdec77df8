#include "lobelia/gather/tree_export.h"

#include <fmt/format.h>

namespace lobelia::gather {
namespace {

constexpr const char* kClassNames[] = {"omni",   "directional", "diffuse",
                                       "glossy", "spherical",   "spherical Gaussian"};
static_assert(std::size(kClassNames) == std::size(kLightClasses));

// Of a preorder: children, parents and leaves. count(i): lights of node i; right(i): of inner ones.
template <class Count, class Right>
void addShape(const Count& count, const Right& right, ExportTable* nodes) {
  const size_t n = nodes->rows;
  std::vector<int32_t> left(n, -1), other(n, -1), parent(n, -1), first(n, 0);
  for (size_t i = 0; i < n; ++i) {  // children come after their parent
    if (count(i) == 1) continue;
    left[i] = static_cast<int32_t>(i + 1);
    other[i] = static_cast<int32_t>(right(i));
    const size_t l = static_cast<size_t>(left[i]), r = static_cast<size_t>(other[i]);
    parent[l] = parent[r] = static_cast<int32_t>(i);
    first[l] = first[i];
    first[r] = first[i] + static_cast<int32_t>(count(l));
  }
  nodes->add("parent", "row of the parent; -1: the root", [&](size_t i) { return parent[i]; });
  nodes->add("left", "row of the first child; -1: a leaf", [&](size_t i) { return left[i]; });
  nodes->add("right", "row of the second child; -1: a leaf", [&](size_t i) { return other[i]; });
  nodes->add("first", "first row of its lights", [&](size_t i) { return first[i]; });
  nodes->add("count", "number of its lights", count);
}

// Of class and index: choice(place).
template <class Choice>
ExportTable lightTable(size_t count, const VirtualLights& lights, const Choice& choice) {
  ExportTable table{"lights", "lights in the order of the leaves", count, {}};
  table.add("class",
            "0 omni, 1 directional, 2 diffuse, 3 glossy, 4 spherical, 5 spherical Gaussian",
            [&](size_t i) { return static_cast<uint32_t>(choice(i).lightClass); });
  table.add("index", "number of the light in its class and part",
            [&](size_t i) { return static_cast<uint32_t>(choice(i).index); });
  table.add("group", "number of its light group", [&](size_t i) {
    return uint32_t{groupOf(lights, choice(i).lightClass, choice(i).index)};
  });
  table.add("power",
            "R, G, B: omni and diffuse the intensity along the normal, W/sr; directional the "
            "irradiance, W/m^2; glossy the Gaussian's integral, spherical and spherical Gaussian "
            "the power, W",
            [&](size_t i) { return lightPower(lights, choice(i).lightClass, choice(i).index); });
  return table;
}

}  // namespace

ExportedTree exportTree(const trees::LightTree& tree, const LightNumbers& numbers,
                        const VirtualLights& lights, const std::string& meaning) {
  ExportedTree out;
  out.meaning = meaning;
  const auto nodes = tree.nodes();
  ExportTable& table = out.nodes;
  table = {"nodes", "nodes in preorder; powers are luminances", nodes.size(), {}};
  addShape([&](size_t i) { return nodes[i].count; },
           [&](size_t i) { return tree.right(static_cast<uint32_t>(i)); }, &table);
  table.add("centre", "mean of the places, by power", [&](size_t i) { return nodes[i].centre; });
  table.add("radius", "all lights are within this distance of the centre",
            [&](size_t i) { return nodes[i].radius; });
  table.add("variance", "mean square distance to the centre",
            [&](size_t i) { return nodes[i].variance; });
  table.add("normal", "mean of the normals by power; 0: light on all sides",
            [&](size_t i) { return nodes[i].n; });
  table.add("diffuse", "sum of the cosine lobes' intensities, W/sr",
            [&](size_t i) { return nodes[i].diffuse; });
  table.add("axis", "of the Gaussian of the same power and mean direction as all",
            [&](size_t i) { return nodes[i].axis; });
  table.add("sharpness", "of that Gaussian", [&](size_t i) { return nodes[i].sharpness; });
  table.add("glossy", "sum of the Gaussians' integrals, W",
            [&](size_t i) { return nodes[i].glossy; });
  out.lights = lightTable(nodes.empty() ? 0 : nodes[0].count, lights, [&](size_t i) {
    return numbers.at(tree.light(static_cast<uint32_t>(i)));
  });
  return out;
}

ExportedTree exportTree(const LightForest::Tree& tree, const VirtualLights& lights) {
  ExportedTree out;
  out.meaning = fmt::format("{} lights of group {}, with bounds{}",
                            kClassNames[static_cast<size_t>(tree.lightClass)], tree.group,
                            tree.apart ? "; no light stands for others" : "");
  const auto nodes = tree.tree.nodes();
  ExportTable& table = out.nodes;
  table = {"nodes",
           "nodes in preorder; but for `power` amounts are luminances, upper bounds of the sums",
           nodes.size(),
           {}};
  addShape([&](size_t i) { return nodes[i].count; },
           [&](size_t i) { return tree.tree.right(static_cast<uint32_t>(i)); }, &table);
  table.add("power", "R, G, B: sum of the lights'", [&](size_t i) { return tree.power[i]; });
  table.add("low", "corner of the box of all places", [&](size_t i) { return nodes[i].lo; });
  table.add("high", "the opposite corner", [&](size_t i) { return nodes[i].hi; });
  table.add("centre", "place of the representative", [&](size_t i) { return nodes[i].centre; });
  table.add("radius", "all places are within this distance of the centre",
            [&](size_t i) { return nodes[i].radius; });
  table.add("normal_axis", "of the cone of normals",
            [&](size_t i) { return decodeOctahedral(nodes[i].normalAxis); });
  table.add("normal_angle", "its half-angle, radians",
            [&](size_t i) { return trees::angleOfCode(nodes[i].normalAngle); });
  table.add("lobe_axis", "of the cone of the Gaussians' axes",
            [&](size_t i) { return decodeOctahedral(nodes[i].lobeAxis); });
  table.add("lobe_angle", "its half-angle, radians",
            [&](size_t i) { return trees::angleOfCode(nodes[i].lobeAngle); });
  table.add("least_sharpness", "of the Gaussians",
            [&](size_t i) { return nodes[i].leastSharpness; });
  table.add("most_sharpness", "of the Gaussians", [&](size_t i) { return nodes[i].mostSharpness; });
  table.add("cosine", "amplitudes of cosine lobes (of light on all sides: intensities)",
            [&](size_t i) { return nodes[i].cosine; });
  table.add("peak", "amplitudes of Gaussians", [&](size_t i) { return nodes[i].peak; });
  table.add("energy", "integrals of Gaussians over the sphere",
            [&](size_t i) { return nodes[i].energy; });
  table.add("normal", "of the representative",
            [&](size_t i) { return decodeOctahedral(nodes[i].n); });
  table.add("axis", "of the representative's Gaussian",
            [&](size_t i) { return decodeOctahedral(nodes[i].axis); });
  table.add("sharpness", "of the representative's Gaussian",
            [&](size_t i) { return nodes[i].sharpness; });
  table.add("amount", "amplitude of the representative's cosine lobe, or its Gaussian's integral",
            [&](size_t i) { return nodes[i].amount; });
  out.lights = lightTable(tree.lights.size(), lights, [&](size_t i) {
    return ChosenLight{tree.lightClass, tree.lights[i]};
  });
  return out;
}

}  // namespace lobelia::gather
