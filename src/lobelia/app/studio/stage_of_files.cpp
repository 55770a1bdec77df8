#include "lobelia/app/studio/stage_of_files.h"

#include <fmt/format.h>

#include "lobelia/io/design.h"
#include "lobelia/store/store.h"
#include "lobelia/transfer/transfer_data.h"

namespace lobelia::app {
namespace {

// Throws InputError where a file of transfer is of the scene without its design. materials: with
// it.
void requireMaterialsOf(const std::vector<std::string>& data, const SceneOptions& options,
                        const std::vector<Material>& materials) {
  Context quiet;
  SceneOptions without = options;
  without.design.clear();
  const Scene before = loadScene(without, quiet);
  const uint64_t hash = transfer::transferHash(before);
  const std::vector<std::string> changed = io::changedMaterials(before.materials, materials);
  for (const std::string& file : data) {
    if (store::kindOf(file) != transfer::kTransferKind || store::sceneHashOf(file) != hash)
      continue;
    throw InputError(
        {options.design},
        fmt::format("this design changes materials{} that the transfer in {} was made with; make "
                    "that again with `lobelia precompute --method vmf --design {}`, or leave the "
                    "option out and show the design by another method, with `design {}` in a "
                    "--script or in the window",
                    changed.empty() ? "" : fmt::format(" ({})", someOf(changed)), file,
                    options.design, options.design));
  }
}

}  // namespace

Stage stageOf(const SceneOptions& options, const std::vector<std::string>& data, Context& context) {
  Scene scene = loadScene(options, context);
  const std::vector<Material> materials = scene.materials;
  try {
    return Stage(std::move(scene), data, context);
  } catch (const InputError&) {
    if (!options.design.empty()) requireMaterialsOf(data, options, materials);
    throw;
  }
}

}  // namespace lobelia::app
