// What `lobelia precompute` made of a scene, by whatever methods: the files of `view --data`.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "lobelia/app/cut_frames.h"
#include "lobelia/app/studio/view_state.h"
#include "lobelia/transfer/transfer_data.h"

namespace lobelia::app {

struct ViewData {
  CutData cuts;
  std::optional<transfer::TransferData> transfer;
  ViewMethod method = ViewMethod::cuts;  // of the first file: what is shown first
};
// Seconds: "data". Throws InputError as relight::load() and transfer::load() do, and UsageError for
// two files of a kind.
ViewData loadViewData(const std::vector<std::string>& files, const Scene& scene, Context& context);
// What pictures from the data will not show of the scene.
void warnOfMissing(const ViewData& data, const Scene& scene, Context& context);

}  // namespace lobelia::app
