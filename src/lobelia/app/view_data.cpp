#include "lobelia/app/view_data.h"

#include <fmt/format.h>

#include "lobelia/app/transfer_frames.h"
#include "lobelia/store/store.h"

namespace lobelia::app {

ViewData loadViewData(const std::vector<std::string>& files, const Scene& scene, Context& context) {
  ViewData out;
  std::vector<std::string> cuts;
  for (const std::string& file : files) {
    const bool transfer = store::kindOf(file) == transfer::kTransferKind;
    if (&file == &files.front()) out.method = transfer ? ViewMethod::transfer : ViewMethod::cuts;
    if (!transfer) {
      cuts.push_back(file);
      continue;
    }
    if (out.transfer)
      throw UsageError(fmt::format(
          "--data {}: this is a second file of --method vmf; give one of each kind at most", file));
    const StageTimer timer(context, "data");
    out.transfer.emplace(transfer::load(file, scene));
  }
  out.cuts = loadCutData(cuts, scene, context);
  return out;
}

void warnOfMissing(const ViewData& data, const Scene& scene, Context& context) {
  if (data.cuts.any() != nullptr) warnOfMissing(data.cuts, scene, context);
  if (!data.transfer) return;
  warnOfMissing(scene, context);
  context.debug(fmt::format("{} passes of transfer for {} vertices", data.transfer->passes.size(),
                            data.transfer->mesh.vertices.size()));
}

}  // namespace lobelia::app
