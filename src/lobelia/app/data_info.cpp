#include "lobelia/app/data_info.h"

#include <fmt/format.h>

#include <filesystem>

#include "lobelia/base/error.h"
#include "lobelia/relight/visibility_summary.h"
#include "lobelia/store/store.h"
#include "lobelia/transfer/transfer_data.h"
#include "lobelia/transfer/transfer_summary.h"

namespace lobelia::app {
namespace {

using Json = nlohmann::ordered_json;

std::string hashText(uint64_t hash) { return fmt::format("{:016x}", hash); }

Json describeTransfer(const std::string& file) {
  const transfer::TransferSummary s = transfer::summaryOf(file);
  return {{"method", "vmf"},        {"scene_hash", hashText(s.sceneHash)},
          {"vertices", s.vertices}, {"directions", s.directions},
          {"passes", s.passes},     {"classes", s.classes},
          {"records", s.records},   {"bytes", s.bytes}};
}

Json describeCuts(const std::string& file) {
  const relight::VisibilitySummary s = relight::summaryOf(file);
  const bool surfaces = s.light == relight::LightSamples::Kind::surfaces;
  return {{"method", "cuts"},
          {"scene_hash", hashText(s.sceneHash)},
          {"light", surfaces ? "surfaces" : "environment"},
          {"vertices", s.vertices},
          {"samples", s.samples},
          {"cut_nodes", s.nodes}};
}

}  // namespace

std::optional<Json> describeData(const std::string& file) {
  std::error_code error;
  if (!std::filesystem::is_regular_file(file, error)) return {};
  const std::string kind = store::kindOf(file);
  if (kind.empty()) return {};
  Json json{{"data", file}, {"kind", kind}};
  if (kind == transfer::kTransferKind) {
    json.update(describeTransfer(file));
  } else if (kind == relight::kVisibilityKind) {
    json.update(describeCuts(file));
  } else {
    throw InputError({file}, fmt::format("holds '{}', of which nothing is told; `lobelia info` "
                                         "describes scenes and what `lobelia precompute` wrote",
                                         kind));
  }
  json["file_bytes"] = std::filesystem::file_size(file);
  return json;
}

}  // namespace lobelia::app
