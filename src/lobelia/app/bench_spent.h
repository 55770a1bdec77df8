// What a piece of work has added to the statistics since this was made.
#pragma once

#include <map>
#include <string>

#include "lobelia/base/context.h"

namespace lobelia::app {

class Spent {
 public:
  explicit Spent(const Context& context) : statistics_(context.statistics) {
    for (const char* stage : kStages) seconds_[stage] = statistics_.seconds(stage);
    for (const char* name : kCounters) counts_[name] = statistics_.count(name);
  }
  double seconds(const std::string& stage) const {
    return statistics_.seconds(stage) - seconds_.at(stage);
  }
  double count(const std::string& name) const {
    return static_cast<double>(statistics_.count(name) - counts_.at(name));
  }
  double total() const { return 1e-9 * static_cast<double>(nanosecondsNow() - start_); }

 private:
  static constexpr const char* kStages[] = {"receivers", "lights",   "trees",      "rows",
                                            "cluster",   "traverse", "visibility", "shade"};
  static constexpr const char* kCounters[] = {
      "shadow_rays",        "shared_rays",       "path_rays",
      "node_pairs_visited", "node_pairs_shaded", "cut_lights",
      "receiver_clusters",  "clustered_lights",  "clustered_receivers"};
  const Statistics& statistics_;
  std::map<std::string, double> seconds_;
  std::map<std::string, uint64_t> counts_;
  int64_t start_ = nanosecondsNow();
};

}  // namespace lobelia::app
