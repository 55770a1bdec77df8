#include "lobelia/app/view_data.h"

#include <fmt/format.h>

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

}  // namespace lobelia::app
