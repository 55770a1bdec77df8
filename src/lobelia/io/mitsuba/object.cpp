// Typed access to the properties of an object of a Mitsuba scene, strict numbers, and transforms.

#include "lobelia/io/mitsuba/object.h"

#include <charconv>

namespace lobelia::io::mitsuba {

Object::Object(const Element& element, const Document& document, Findings& findings)
    : element_(element), findings_(findings) {
  for (const Element& child : element.children) {
    if (child.tag != "ref") {
      children_.push_back({child.name, &child, child.where});
      continue;
    }
    const std::string& id = child.value("id");
    const auto target = document.byId.find(id);
    if (target == document.byId.end()) {
      std::vector<std::string> ids;
      for (const auto& [known, unused] : document.byId) ids.push_back(known);
      throw InputError(child.where, "nothing has the id '" + id + "'" + suggestion(id, ids));
    }
    children_.push_back({child.name, target->second, child.where});
  }
}

const Element* Object::property(const std::string& name) {
  known_.push_back(name);
  const Element* found = nullptr;
  for (Child& child : children_) {
    if (child.name != name) continue;
    if (found && !child.used) {
      findings_.warn(child.where, "'" + name + "' is given twice; the last one counts");
    }
    found = child.element;
    child.used = true;
  }
  return found;
}

std::optional<double> Object::number(const std::string& name) {
  const Element* e = property(name);
  if (!e) return {};
  if (e->tag != "float" && e->tag != "integer") wrongKind(*e, "<float>");
  return parseNumber(e->value("value"), *e);
}

float Object::number(const std::string& name, float otherwise) {
  const std::optional<double> value = number(name);
  return value ? static_cast<float>(*value) : otherwise;
}

std::optional<int> Object::integer(const std::string& name) {
  const Element* e = property(name);
  if (!e) return {};
  if (e->tag == "float") {
    const double value = parseNumber(e->value("value"), *e);
    if (value == std::floor(value) && std::abs(value) < 2e9) return static_cast<int>(value);
  }
  if (e->tag != "integer") wrongKind(*e, "<integer>");
  return parseInteger(e->value("value"), *e);
}

int Object::integer(const std::string& name, int otherwise) {
  return integer(name).value_or(otherwise);
}

std::optional<int> Object::hint(const std::string& name) {
  try {
    return integer(name);
  } catch (const InputError&) {
    findings_.warn(where(), "the hint '" + name + "' is not an integer and is ignored");
    return {};
  }
}

bool Object::boolean(const std::string& name, bool otherwise) {
  const Element* e = property(name);
  if (!e) return otherwise;
  if (e->tag != "boolean") wrongKind(*e, "<boolean>");
  std::string value = e->value("value");
  for (char& c : value) c = static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
  if (value == "true") return true;
  if (value == "false") return false;
  throw InputError(e->where, "'" + e->value("value") + "' is not a boolean; write true or false");
}

std::optional<std::string> Object::string(const std::string& name) {
  const Element* e = property(name);
  if (!e) return {};
  if (e->tag != "string") wrongKind(*e, "<string>");
  return e->value("value");
}

std::optional<Vec3d> Object::vector(const std::string& name) {
  const Element* e = property(name);
  if (!e) return {};
  if (e->tag != "point" && e->tag != "vector") wrongKind(*e, "<point> or <vector>");
  return parseVector(*e, 0);
}

std::optional<Mat4> Object::transform(const std::string& name) {
  const Element* e = property(name);
  if (!e) return {};
  if (e->tag == "animation") {
    findings_.warn(e->where, "moving objects are not supported; the first key frame is used");
    if (e->children.empty()) return {};
    return parseTransform(e->children.front());
  }
  if (e->tag != "transform") wrongKind(*e, "<transform>");
  return parseTransform(*e);
}

std::vector<const Element*> Object::nested(const std::string& tag) {
  std::vector<const Element*> found;
  for (Child& child : children_) {
    if (child.used || child.element->tag != tag) continue;
    child.used = true;
    found.push_back(child.element);
  }
  return found;
}

void Object::ignore(const std::vector<std::string>& names) {
  for (const std::string& name : names) property(name);
}

void Object::finish() {
  for (const Child& child : children_) {
    if (child.used) continue;
    const std::string owner = element_.tag + " '" + element_.valueOr("type", element_.tag) + "'";
    if (child.name.empty()) {
      findings_.warn(child.where,
                     "nothing in the " + owner + " uses this <" + child.element->tag + ">");
    } else {
      findings_.warn(child.where, "unknown property '" + child.name + "' of the " + owner +
                                      " is ignored" + suggestion(child.name, known_));
    }
  }
}

void unknownType(const Object& object, const std::vector<std::string>& known) {
  const std::string& type = object.type();
  std::string hint = suggestion(type, known);
  if (hint.empty()) {
    hint = "; known are";
    for (const std::string& name : known) hint += (&name == &known.front() ? " " : ", ") + name;
  }
  throw InputError(object.where(), "unknown " + object.element().tag + " '" + type + "'" + hint);
}

void wrongKind(const Element& element, const std::string& expected) {
  throw InputError(element.where,
                   "'" + element.name + "' is a <" + element.tag + ">; it should be a " + expected);
}

double parseNumber(const std::string& text, const Element& element) {
  const size_t start = text.find_first_not_of(" \t\r\n");
  const size_t end = text.find_last_not_of(" \t\r\n");
  double value = 0;
  bool valid = false;
  if (start != std::string::npos) {
    const char* first = text.data() + start + (text[start] == '+' ? 1 : 0);
    const char* last = text.data() + end + 1;
    const auto result = std::from_chars(first, last, value);
    valid = result.ec == std::errc() && result.ptr == last;
    // Too small to be represented is as good as zero.
    if (result.ec == std::errc::result_out_of_range && result.ptr == last &&
        text.find("e-") != std::string::npos) {
      value = 0;
      valid = true;
    }
  }
  if (!valid || !std::isfinite(value) || std::abs(value) > 3.4e38) {
    throw InputError(element.where, "'" + text + "' is not a finite number");
  }
  return value;
}

int parseInteger(const std::string& text, const Element& element) {
  const std::vector<std::string> words = tokens(text);
  int value = 0;
  if (words.size() == 1) {
    const std::string& word = words[0];
    const char* first = word.data() + (word[0] == '+' ? 1 : 0);
    const auto result = std::from_chars(first, word.data() + word.size(), value);
    if (result.ec == std::errc() && result.ptr == word.data() + word.size()) return value;
  }
  throw InputError(element.where, "'" + text + "' is not an integer of 32 bits");
}

std::vector<std::string> tokens(const std::string& text) {
  constexpr const char* kSeparators = " \t\r\n,";
  std::vector<std::string> words;
  size_t at = text.find_first_not_of(kSeparators);
  while (at != std::string::npos) {
    const size_t end = text.find_first_of(kSeparators, at);
    words.push_back(text.substr(at, end - at));
    at = text.find_first_not_of(kSeparators, end);
  }
  return words;
}

std::vector<double> parseNumbers(const std::string& text, const Element& element) {
  std::vector<double> numbers;
  for (const std::string& word : tokens(text)) numbers.push_back(parseNumber(word, element));
  return numbers;
}

Vec3d parseVector(const Element& element, double otherwise) {
  const bool components = element.has("x") || element.has("y") || element.has("z");
  if (element.has("value")) {
    if (components) {
      throw InputError(element.where,
                       "<" + element.tag + "> has both value and x, y, z; give one of them");
    }
    const std::vector<double> v = parseNumbers(element.value("value"), element);
    if (v.size() == 1) return Vec3d(v[0]);
    if (v.size() == 3) return {v[0], v[1], v[2]};
    throw InputError(element.where, "<" + element.tag + "> needs one or three values, not " +
                                        std::to_string(v.size()));
  }
  const auto component = [&](const char* name) {
    return element.has(name) ? parseNumber(element.value(name), element) : otherwise;
  };
  return {component("x"), component("y"), component("z")};
}

namespace {

Vec3d namedVector(const Element& element, const char* attribute) {
  const std::vector<double> v = parseNumbers(element.value(attribute), element);
  if (v.size() != 3) {
    throw InputError(element.where, std::string("'") + attribute + "' needs three values, not " +
                                        std::to_string(v.size()));
  }
  return {v[0], v[1], v[2]};
}

// Any direction orthogonal to d, for a <lookat> without up.
Vec3d orthogonal(Vec3d d) {
  return std::abs(d.x) > std::abs(d.y) ? cross(d, Vec3d{0, 1, 0}) : cross(d, Vec3d{1, 0, 0});
}

Mat4 parseLookAt(const Element& element) {
  const Vec3d origin = namedVector(element, "origin"), target = namedVector(element, "target");
  Vec3d up = element.has("up") ? namedVector(element, "up") : Vec3d{};
  if (lengthSquared(up) == 0) up = orthogonal(target - origin);
  const std::optional<Mat4> matrix = lookAt(origin, target, up);
  if (!matrix) {
    throw InputError(element.where,
                     "<lookat> has no direction: origin and target must differ, and up must not "
                     "be parallel to the line between them");
  }
  return *matrix;
}

Mat4 parseMatrix(const Element& element, bool planar) {
  const std::vector<double> v = parseNumbers(element.value("value"), element);
  if (v.size() != 16 && v.size() != 9) {
    throw InputError(element.where,
                     "<matrix> has " + std::to_string(v.size()) + " values; it needs 16 or 9");
  }
  const size_t n = v.size() == 16 ? 4 : 3;
  Mat4 out;
  for (size_t i = 0; i < n; ++i) {
    for (size_t j = 0; j < n; ++j) out.m[i][j] = v[i * n + j];
  }
  if (planar && n == 3) {
    for (size_t i = 0; i < 2; ++i) {
      out.m[i][3] = out.m[i][2];
      out.m[i][2] = 0;
    }
    out.m[2] = {0, 0, 1, 0};
  }
  return out;
}

Mat4 parseOperation(const Element& element, bool planar) {
  if (element.tag == "translate") return translation(parseVector(element, 0));
  if (element.tag == "scale") return scaling(parseVector(element, 1));
  if (element.tag == "lookat") return parseLookAt(element);
  if (element.tag == "matrix") return parseMatrix(element, planar);
  if (element.tag == "rotate") {
    Vec3d axis = parseVector(element, 0);
    if (planar && lengthSquared(axis) == 0) axis = {0, 0, 1};
    if (lengthSquared(axis) == 0) {
      throw InputError(element.where, "<rotate> has no axis; give x, y, z, for example y=\"1\"");
    }
    return rotation(axis, parseNumber(element.value("angle"), element));
  }
  throw InputError(element.where, "<" + element.tag +
                                      "> cannot be in a transform; translate, rotate, scale, "
                                      "lookat and matrix can");
}

}  // namespace

Mat4 parseTransform(const Element& element, bool planar) {
  Mat4 result;
  for (const Element& operation : element.children) {
    result = parseOperation(operation, planar) * result;
  }
  if (!result.isFinite()) throw InputError(element.where, "the transform is not finite");
  const auto& last = result.m[3];
  if (last[0] != 0 || last[1] != 0 || last[2] != 0 || last[3] != 1) {
    throw InputError(element.where, "the transform is not affine; its last row must be 0 0 0 1");
  }
  if (!inverse(result)) {
    throw InputError(element.where, "the transform is singular; it flattens everything");
  }
  return result;
}

}  // namespace lobelia::io::mitsuba
