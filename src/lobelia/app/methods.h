// Which light models and gather strategies there are and which combine.
#pragma once

#include <string>
#include <vector>

namespace lobelia::app {

struct LightModel {
  std::string name, summary;
  std::vector<std::string> gathers;  // empty: needs none (path, light)
};
struct GatherStrategy {
  std::string name, summary;
};

const std::vector<LightModel>& lightModels();
const std::vector<GatherStrategy>& gatherStrategies();

std::vector<std::string> lightModelNames();
std::vector<std::string> gatherStrategyNames();

// Throws UsageError with the nearest known name, or with what combines.
void requireMethod(const std::string& lights, const std::string& gather);
std::string methodTable();

}  // namespace lobelia::app
