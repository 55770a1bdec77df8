#include "lobelia/scene/light_groups.h"

#include <limits>
#include <map>

#include "lobelia/base/error.h"

namespace lobelia {

LightGroups lightGroups(const Scene& scene) {
  std::map<std::string, uint16_t> index;
  for (const Emitter& emitter : scene.emitters)
    if (!emitter.group.empty() && emitter.group != LightGroups::kDefaultGroup)
      index.emplace(emitter.group, uint16_t{0});
  if (index.size() >= std::numeric_limits<uint16_t>::max())
    throw InputError({scene.file, 0, 0}, "more light groups than 65534; fewer can be told apart");
  LightGroups groups;
  groups.names.emplace_back(LightGroups::kDefaultGroup);
  for (auto& [name, number] : index) {
    number = static_cast<uint16_t>(groups.names.size());
    groups.names.push_back(name);
  }
  groups.used.assign(groups.size(), true);
  if (index.empty()) return groups;
  groups.used[0] = false;
  for (const Emitter& emitter : scene.emitters) {
    const auto it = index.find(emitter.group);
    groups.ofEmitter.push_back(it == index.end() ? uint16_t{0} : it->second);
    if (it == index.end()) groups.used[0] = true;
  }
  return groups;
}

}  // namespace lobelia
