// Parameter types are those of PBRT-v4; "point", "vector", "color" and "xyz" of older files are
// read too, as are booleans in quotes.
#include "lobelia/io/pbrt/parameters.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>

namespace lobelia::io::pbrt {
namespace {

enum class Values : uint8_t { numbers, strings, booleans, either };

struct Type {
  const char* name;
  Values values;
};
constexpr Type kTypes[] = {
    {"integer", Values::numbers}, {"float", Values::numbers},     {"point2", Values::numbers},
    {"vector2", Values::numbers}, {"point3", Values::numbers},    {"vector3", Values::numbers},
    {"point", Values::numbers},   {"vector", Values::numbers},    {"normal", Values::numbers},
    {"normal3", Values::numbers}, {"rgb", Values::numbers},       {"color", Values::numbers},
    {"xyz", Values::numbers},     {"blackbody", Values::numbers}, {"spectrum", Values::either},
    {"string", Values::strings},  {"texture", Values::strings},   {"bool", Values::booleans},
};

const std::vector<std::string>& typeNames() {
  static const std::vector<std::string> names = [] {
    std::vector<std::string> out;
    for (const Type& type : kTypes) out.emplace_back(type.name);
    return out;
  }();
  return names;
}

// Splits "type name".
Values declare(const Token& token, Parameter* out) {
  const std::string& text = token.text;
  constexpr const char* kSpace = " \t";
  const size_t typeBegin = text.find_first_not_of(kSpace);
  const size_t typeEnd = text.find_first_of(kSpace, typeBegin);
  const size_t nameBegin = text.find_first_not_of(kSpace, typeEnd);
  if (typeBegin == text.npos || typeEnd == text.npos || nameBegin == text.npos)
    throw InputError(token.where,
                     fmt::format("'{}' is no parameter; it should be \"type name\"", text));
  out->type = text.substr(typeBegin, typeEnd - typeBegin);
  out->name = text.substr(nameBegin, text.find_first_of(kSpace, nameBegin) - nameBegin);
  out->where = token.where;
  for (const Type& type : kTypes)
    if (out->type == type.name) return type.values;
  throw InputError(token.where, unknownName("parameter type", out->type, typeNames()));
}

void addValue(Parameter& p, Values values, const Token& token) {
  const bool isWord = token.type == TokenType::word;
  if (values == Values::booleans) {
    if (token.text != "true" && token.text != "false")
      throw InputError(token.where, fmt::format("'{}' is the value of the bool '{}'; it may be "
                                                "true or false",
                                                token.text, p.name));
    p.booleans.push_back(token.text == "true");
  } else if (isWord && values == Values::strings) {
    throw InputError(token.where, fmt::format("'{}' is the value of the {} '{}'; put it in quotes",
                                              token.text, p.type, p.name));
  } else if (isWord) {
    p.numbers.push_back(parseNumber(token.text, token.where));
  } else if (values == Values::numbers) {
    throw InputError(token.where,
                     fmt::format("the {} '{}' has the string \"{}\" as a value; it takes numbers",
                                 p.type, p.name, token.text));
  } else {
    p.strings.push_back(token.text);
  }
}

Parameter readParameter(Tokenizer& in) {
  Parameter p;
  const Values values = declare(*in.next(), &p);
  const auto fail = [&] {
    throw InputError(p.where, fmt::format("the parameter '{}' has no value", p.name));
  };
  std::optional<Token> token = in.next();
  if (!token || token->type == TokenType::close) fail();
  if (token->type != TokenType::open) {
    addValue(p, values, *token);
    return p;
  }
  for (;;) {
    if (values == Values::numbers || values == Values::either) in.numbers(p.numbers);
    token = in.next();
    if (!token)
      throw InputError(p.where,
                       fmt::format("the values of '{}' do not end; a ']' is missing", p.name));
    if (token->type == TokenType::close) break;
    if (token->type == TokenType::open)
      throw InputError(token->where, "a '[' within brackets; close the first one before");
    addValue(p, values, *token);
  }
  return p;
}

}  // namespace

std::string unknownName(const std::string& kind, const std::string& name,
                        const std::vector<std::string>& known) {
  const std::string near = suggestion(name, known);
  return fmt::format("unknown {} '{}'{}", kind, name,
                     near.empty() ? fmt::format("; known are {}", fmt::join(known, ", ")) : near);
}

std::vector<Parameter> readParameters(Tokenizer& in) {
  std::vector<Parameter> list;
  while (in.peek() && in.peek()->type == TokenType::string) list.push_back(readParameter(in));
  return list;
}

Parameters::Parameters(std::vector<Parameter> own, const std::vector<Parameter>& defaults,
                       const Location& where)
    : list_(std::move(own)), where_(where) {
  for (size_t i = 0; i < list_.size(); ++i)
    for (size_t j = 0; j < i; ++j)
      if (list_[i].name == list_[j].name)
        throw InputError(list_[i].where, fmt::format("the parameter '{}' is given twice; the first "
                                                     "time in line {}",
                                                     list_[i].name, list_[j].where.line));
  // The last of several Attribute directives counts.
  for (auto p = defaults.rbegin(); p != defaults.rend(); ++p) {
    if (has(p->name)) continue;
    list_.push_back(*p);
    list_.back().isDefault = true;
  }
}

bool Parameters::has(const std::string& name) const {
  return std::any_of(list_.begin(), list_.end(),
                     [&](const Parameter& p) { return p.name == name; });
}

const Parameter* Parameters::find(const std::string& name, const std::vector<std::string>& types) {
  known_.push_back(name);
  for (Parameter& p : list_) {
    if (p.name != name) continue;
    p.used = true;
    if (std::find(types.begin(), types.end(), p.type) == types.end())
      throw InputError(p.where, fmt::format("'{}' is a {}; it should be of type {}", name, p.type,
                                            fmt::join(types, " or ")));
    return &p;
  }
  return nullptr;
}

namespace {

void requireCount(const Parameter& p, size_t found, size_t expected) {
  if (found != expected)
    throw InputError(p.where,
                     fmt::format("'{}' has {} values; it takes {}", p.name, found, expected));
}

void requireMultiple(const Parameter& p, size_t size) {
  if (p.numbers.size() % size != 0)
    throw InputError(p.where,
                     fmt::format("'{}' has {} numbers; a list of {} takes a multiple of {}", p.name,
                                 p.numbers.size(), p.type, size));
}

float toFloat(double v, const Parameter& p) {
  const auto f = static_cast<float>(v);
  if (!std::isfinite(f))
    throw InputError(p.where, fmt::format("'{}' has the value {}, which is too large", p.name, v));
  return f;
}

}  // namespace

std::optional<double> Parameters::number(const std::string& name) {
  const Parameter* p = find(name, {"float", "integer"});
  if (!p) return std::nullopt;
  requireCount(*p, p->numbers.size(), 1);
  return toFloat(p->numbers[0], *p);
}

float Parameters::number(const std::string& name, float otherwise) {
  return static_cast<float>(number(name).value_or(static_cast<double>(otherwise)));
}

int Parameters::integer(const std::string& name, int otherwise) {
  const Parameter* p = find(name, {"integer"});
  if (!p) return otherwise;
  requireCount(*p, p->numbers.size(), 1);
  const double v = p->numbers[0];
  if (v != std::floor(v) || std::abs(v) > 2147483647)
    throw InputError(p->where, fmt::format("'{}' is {}; it should be a whole number", name, v));
  return static_cast<int>(v);
}

bool Parameters::boolean(const std::string& name, bool otherwise) {
  const Parameter* p = find(name, {"bool"});
  if (!p) return otherwise;
  requireCount(*p, p->booleans.size(), 1);
  return p->booleans[0];
}

std::optional<std::string> Parameters::string(const std::string& name) {
  const Parameter* p = find(name, {"string"});
  if (!p) return std::nullopt;
  requireCount(*p, p->strings.size(), 1);
  return p->strings[0];
}

std::string Parameters::string(const std::string& name, const std::string& otherwise) {
  return string(name).value_or(otherwise);
}

Vec3d Parameters::point(const std::string& name, Vec3d otherwise) {
  const Parameter* p = find(name, {"point3", "vector3", "point", "vector"});
  if (!p) return otherwise;
  requireCount(*p, p->numbers.size(), 3);
  return {p->numbers[0], p->numbers[1], p->numbers[2]};
}

std::vector<double> Parameters::numbers(const std::string& name) {
  const Parameter* p = find(name, {"float", "integer"});
  return p ? p->numbers : std::vector<double>{};
}

std::vector<uint32_t> Parameters::indices(const std::string& name) {
  std::vector<uint32_t> out;
  const Parameter* p = find(name, {"integer"});
  if (!p) return out;
  out.reserve(p->numbers.size());
  for (const double v : p->numbers) {
    if (!(v >= 0) || v > 4294967294.0 || v != std::floor(v))
      throw InputError(p->where, fmt::format("'{}' has {}, which is no index", name, v));
    out.push_back(static_cast<uint32_t>(v));
  }
  return out;
}

std::vector<Vec3f> Parameters::vectors3(const std::string& name) {
  std::vector<Vec3f> out;
  const Parameter* p = find(name, {"point3", "vector3", "normal", "normal3", "point", "vector"});
  if (!p) return out;
  requireMultiple(*p, 3);
  out.reserve(p->numbers.size() / 3);
  for (size_t i = 0; i < p->numbers.size(); i += 3)
    out.emplace_back(toFloat(p->numbers[i], *p), toFloat(p->numbers[i + 1], *p),
                     toFloat(p->numbers[i + 2], *p));
  return out;
}

std::vector<Vec2f> Parameters::vectors2(const std::string& name) {
  std::vector<Vec2f> out;
  const Parameter* p = find(name, {"point2", "vector2", "float"});
  if (!p) return out;
  requireMultiple(*p, 2);
  out.reserve(p->numbers.size() / 2);
  for (size_t i = 0; i < p->numbers.size(); i += 2)
    out.emplace_back(toFloat(p->numbers[i], *p), toFloat(p->numbers[i + 1], *p));
  return out;
}

std::vector<std::string> Parameters::strings(const std::string& name) {
  const Parameter* p = find(name, {"string", "texture"});
  return p ? p->strings : std::vector<std::string>{};
}

void Parameters::ignore(const std::vector<std::string>& names) {
  for (Parameter& p : list_)
    if (std::find(names.begin(), names.end(), p.name) != names.end()) p.used = true;
  known_.insert(known_.end(), names.begin(), names.end());
}

void Parameters::unsupported(const std::string& name, const std::string& consequence,
                             Findings& findings) {
  known_.push_back(name);
  for (Parameter& p : list_) {
    if (p.name != name || p.used) continue;
    p.used = true;
    findings.warn(p.where, fmt::format("'{}' is not supported; {}", name, consequence));
  }
}

void Parameters::finish(const std::string& what, Findings& findings) {
  for (const Parameter& p : list_) {
    if (p.used || p.isDefault) continue;
    findings.warn(p.where, fmt::format("the parameter '{}' means nothing to the {}{}", p.name, what,
                                       suggestion(p.name, known_)));
  }
}

}  // namespace lobelia::io::pbrt
