// The elements that Mitsuba's scene files consist of, and the attributes that each may have.
#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace lobelia::io::mitsuba {

struct Tag {
  const char* name;
  bool object;  // a plugin with properties inside
  std::vector<std::string> attributes;
};
const std::vector<Tag>& knownTags();
const Tag* findTag(std::string_view name);  // null: unknown
// Today's name of a tag: 0.6 has lookAt, files before 0.4 have luminaire and camera.
std::string normalTag(std::string_view tag);

}  // namespace lobelia::io::mitsuba
