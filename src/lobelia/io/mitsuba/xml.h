// A Mitsuba scene file as a tree of elements with their places: includes are spliced in, parameters
// ($name) substituted, names in one spelling (snake_case), unknown elements reported and left out.
#pragma once

#include <map>
#include <string>
#include <string_view>
#include <vector>

#include "lobelia/io/findings.h"

namespace lobelia::io::mitsuba {

struct Attribute {
  std::string name, value;
  std::string undefined;  // the first parameter in the value that has no value
};

struct Element {
  std::string tag;
  std::string name;  // the name attribute in snake_case
  Location where;
  bool legacy = false;  // from a file of version 0.x: Mitsuba 0.6's defaults apply
  std::vector<Attribute> attributes;
  std::vector<Element> children;

  const Attribute* find(std::string_view attribute) const;
  bool has(std::string_view attribute) const { return find(attribute) != nullptr; }
  // Value of an attribute; throws InputError when it is missing or has an undefined parameter.
  const std::string& value(std::string_view attribute) const;
  // The attribute's value, or "" when there is none; throws on an undefined parameter.
  std::string valueOr(std::string_view attribute, std::string_view otherwise) const;
};

struct Document {
  Element scene;
  std::vector<std::string> searchPaths;  // first match counts
  std::map<std::string, const Element*> byId;

  // Full path of a file that `from` names; throws InputError that lists where it was sought.
  std::string resolve(const std::string& file, const Location& from) const;
};

// Throws InputError: unreadable or malformed files, a root that is not <scene>, cyclic or too deep
// includes, too deep nesting, duplicate ids.
Document loadDocument(const std::string& file,
                      const std::map<std::string, std::string>& definitions, Findings& findings);

// "maxDepth" -> "max_depth", "intIOR" -> "int_ior"; snake_case stays as it is.
std::string snakeCase(std::string_view name);

}  // namespace lobelia::io::mitsuba
