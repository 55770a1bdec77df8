// An object of a scene (a plugin with properties) as the reader looks at it: typed access to its
// properties, and a memory of what was asked for, so that the rest can be reported.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "lobelia/base/transform.h"
#include "lobelia/io/mitsuba/xml.h"

namespace lobelia::io::mitsuba {

class Object {
 public:
  // The element is an object's; references are resolved here. Throws InputError on unknown ids.
  Object(const Element& element, const Document& document, Findings& findings);

  const Element& element() const { return element_; }
  const Location& where() const { return element_.where; }
  bool legacy() const { return element_.legacy; }
  const std::string& type() const { return element_.value("type"); }
  std::string id() const { return element_.valueOr("id", ""); }

  // The property or nested object of that name, null when there is none. Marks it as used.
  const Element* property(const std::string& name);
  bool has(const std::string& name) { return property(name) != nullptr; }
  std::optional<double> number(const std::string& name);  // float or integer
  float number(const std::string& name, float otherwise);
  std::optional<int> integer(const std::string& name);
  int integer(const std::string& name, int otherwise);
  bool boolean(const std::string& name, bool otherwise);
  std::optional<std::string> string(const std::string& name);
  std::optional<Vec3d> vector(const std::string& name);  // point or vector
  std::optional<Mat4> transform(const std::string& name);
  // Integer of a hint: what cannot be read is a warning.
  std::optional<int> hint(const std::string& name);

  // All nested objects with the tag that were not used yet, in the order of the file.
  std::vector<const Element*> nested(const std::string& tag);
  // Properties that have no meaning here and are no mistake.
  void ignore(const std::vector<std::string>& names);
  // Warns of everything that nobody asked for.
  void finish();

 private:
  struct Child {
    std::string name;
    const Element* element;  // a reference's target
    Location where;
    bool used = false;
  };
  const Element& element_;
  Findings& findings_;
  std::vector<Child> children_;
  std::vector<std::string> known_;
};

// "unknown bsdf 'foo'; did you mean 'bar'?", or the list of known types when none is near.
[[noreturn]] void unknownType(const Object& object, const std::vector<std::string>& known);
[[noreturn]] void wrongKind(const Element& element, const std::string& expected);

// Strict numbers: nothing may follow, and they are finite. Throw InputError at `element`.
double parseNumber(const std::string& text, const Element& element);
int parseInteger(const std::string& text, const Element& element);
std::vector<std::string> tokens(const std::string& text);  // separated by spaces and commas
std::vector<double> parseNumbers(const std::string& text, const Element& element);
// value="x y z" or value="s", or x, y, z attributes with a default for those missing.
Vec3d parseVector(const Element& element, double otherwise);
// The product of a <transform>'s operations in order. planar: a transform of texture coordinates
// (a matrix of nine values is then homogeneous, its third column the translation). Throws when it
// is singular, not finite or not affine.
Mat4 parseTransform(const Element& element, bool planar = false);

}  // namespace lobelia::io::mitsuba
