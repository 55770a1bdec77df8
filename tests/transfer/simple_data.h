// Transfer data made by hand: of a scene's own vertices, by functions of vertex and direction.
#pragma once

#include <optional>

#include "lobelia/transfer/transfer_data.h"
#include "support/box_scene.h"

namespace lobelia::transfer::test {

using lobelia::test::addMaterial;
using lobelia::test::addQuad;

inline Material phongMaterial(Rgb specular, float exponent, Rgb diffuse = {}) {
  Material m;
  m.type = MaterialType::phong;
  m.diffuse = diffuse;
  m.specular = specular;
  m.alphaU = exponent;
  return m;
}

// One pass in which nothing is in the way.
inline TransferData simpleData(const Scene& scene) {
  TransferData data;
  data.mesh.mesh = splitMesh(scene);
  data.mesh.vertices = transferVertices(scene, data.mesh.mesh);
  const size_t columns = GeodesicGrid(data.directionLevel).count();
  data.reflection = SliceRows(columns);
  SliceRows rows(columns);
  for (size_t v = 0; v < data.mesh.vertices.size(); ++v) {
    rows.addRow({}, {});
    data.reflection.addRow({}, {});
  }
  data.passes.push_back({{std::move(rows)}, {}});
  return data;
}

// lobeOf(vertex, direction): std::optional<TransferLobe>.
template <class F>
SliceRows rowsOf(const TransferData& data, const F& lobeOf) {
  const GeodesicGrid grid(data.directionLevel);
  SliceRows rows(grid.count());
  for (const TransferVertex& vertex : data.mesh.vertices) {
    std::vector<uint32_t> columns;
    std::vector<SliceRecord> records;
    for (uint32_t i = 0; i < grid.count(); ++i) {
      const std::optional<TransferLobe> lobe = lobeOf(vertex, grid.directions()[i]);
      if (!lobe) continue;
      columns.push_back(i);
      records.push_back(pack(*lobe));
    }
    rows.addRow(columns, records);
  }
  return rows;
}

}  // namespace lobelia::transfer::test
