// Parameter lists of PBRT directives: typed access, and a memory of what was asked for, so that the
// rest can be reported.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "lobelia/base/vec.h"
#include "lobelia/io/findings.h"
#include "lobelia/io/pbrt/tokenizer.h"

namespace lobelia::io::pbrt {

struct Parameter {
  std::string type, name;
  Location where;
  std::vector<double> numbers;
  std::vector<std::string> strings;
  std::vector<bool> booleans;
  bool isDefault = false;  // from an Attribute directive: nobody has to use it
  bool used = false;
};

// Reads "type name" value pairs up to the next directive. Throws InputError.
std::vector<Parameter> readParameters(Tokenizer& in);

class Parameters {
 public:
  Parameters() = default;
  // defaults: given by Attribute; they hold where `own` has no parameter of the name.
  Parameters(std::vector<Parameter> own, const std::vector<Parameter>& defaults,
             const Location& where);

  const Location& where() const { return where_; }
  bool has(const std::string& name) const;
  // The parameter of any of the types; null when there is none of that name. Marks it as used;
  // throws InputError when its type is another.
  const Parameter* find(const std::string& name, const std::vector<std::string>& types);

  // One value. Throw InputError on a wrong type or count.
  std::optional<double> number(const std::string& name);
  float number(const std::string& name, float otherwise);
  int integer(const std::string& name, int otherwise);
  bool boolean(const std::string& name, bool otherwise);
  std::optional<std::string> string(const std::string& name);
  std::string string(const std::string& name, const std::string& otherwise);
  Vec3d point(const std::string& name, Vec3d otherwise);
  // Lists; empty when not given.
  std::vector<double> numbers(const std::string& name);
  std::vector<uint32_t> indices(const std::string& name);
  std::vector<Vec3f> vectors3(const std::string& name);
  std::vector<Vec2f> vectors2(const std::string& name);
  std::vector<std::string> strings(const std::string& name);

  // Marks as used what has no meaning here and is no mistake.
  void ignore(const std::vector<std::string>& names);
  // A parameter that has a meaning in PBRT and none here: a warning that says so.
  void unsupported(const std::string& name, const std::string& consequence, Findings& findings);
  // Warns of everything that nobody asked for, with the nearest name that was.
  void finish(const std::string& what, Findings& findings);

 private:
  std::vector<Parameter> list_;
  std::vector<std::string> known_;
  Location where_;
};

// "unknown shape 'foo'; did you mean 'bar'?", or the list when none is near.
std::string unknownName(const std::string& kind, const std::string& name,
                        const std::vector<std::string>& known);

}  // namespace lobelia::io::pbrt
