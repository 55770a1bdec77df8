// Directives that change or save the graphics state, objects and media.
#include <fmt/format.h>

#include <cstring>

#include "lobelia/io/pbrt/reader.h"

namespace lobelia::io::pbrt {
namespace {

constexpr size_t kMaxNesting = 4096;
constexpr size_t kMaxInstances = size_t{1} << 26;

}  // namespace

void Reader::push(const Token& token, const char* kind) {
  if (saved_.size() >= kMaxNesting)
    throw InputError(token.where,
                     fmt::format("more than {} levels of Begin directives", kMaxNesting));
  saved_.push_back({state_, kind, token.where});
}

void Reader::pop(const Token& token, const char* kind) {
  if (saved_.empty())
    throw InputError(token.where, fmt::format("{} without a {}Begin before it", token.text, kind));
  const Saved& open = saved_.back();
  if (std::strcmp(open.kind, kind) != 0)
    throw InputError(token.where, fmt::format("{} ends the {}Begin of line {}; {}End was expected",
                                              token.text, open.kind, open.where.line, open.kind));
  state_ = std::move(saved_.back().state);
  saved_.pop_back();
}

void Reader::attributeBegin(const Token& token) { push(token, "Attribute"); }
void Reader::attributeEnd(const Token& token) { pop(token, "Attribute"); }

void Reader::transformBegin(const Token& token) { push(token, "Transform"); }

// Only the transformation is restored.
void Reader::transformEnd(const Token& token) {
  State now = state_;
  pop(token, "Transform");
  now.ctm = state_.ctm;
  now.atStart = state_.atStart, now.atEnd = state_.atEnd;
  state_ = std::move(now);
}

void Reader::objectBegin(const Token& token) {
  const std::string name = quoted(token, "name");
  if (inObject_) throw InputError(token.where, "an object cannot be defined within another");
  if (objects_.contains(name))
    throw InputError(token.where, fmt::format("the object '{}' is defined twice", name));
  push(token, "Object");
  inObject_ = true;
  openObject_ = name;
  objects_[name];
}

void Reader::objectEnd(const Token& token) {
  pop(token, "Object");
  inObject_ = false;
}

void Reader::objectInstance(const Token& token) {
  const std::string name = quoted(token, "name");
  if (inObject_) throw InputError(token.where, "an object cannot hold an ObjectInstance");
  const auto object = objects_.find(name);
  if (object == objects_.end()) {
    std::vector<std::string> known;
    for (const auto& [other, shapes] : objects_) known.push_back(other);
    throw InputError(token.where, unknownName("object", name, known));
  }
  if (scene_.instances.size() + object->second.size() > kMaxInstances)
    throw InputError(token.where, fmt::format("more than {} instances", kMaxInstances));
  for (Instance copy : object->second) {
    copy.toWorld = placement(state_.ctm * copy.toWorld.to, token.where);
    scene_.instances.push_back(std::move(copy));
  }
}

void Reader::attribute(const Token& token) {
  const std::string target = quoted(token, "target");
  const std::vector<std::string> known{"shape", "light", "material", "medium", "texture"};
  if (std::find(known.begin(), known.end(), target) == known.end())
    throw InputError(token.where, unknownName("target of Attribute", target, known));
  for (Parameter& p : readParameters(*in_)) state_.defaults[target].push_back(std::move(p));
}

void Reader::colorSpace(const Token& token) {
  const std::string name = quoted(token, "name");
  const std::optional<ColorSpace> space = ColorSpace::named(name);
  if (!space) throw InputError(token.where, unknownName("colour space", name, ColorSpace::names()));
  state_.colorSpace = *space;
}

// Options steer PBRT's own program.
void Reader::option(const Token& token) {
  for (const Parameter& p : readParameters(*in_))
    findings_.inform(p.where,
                     fmt::format("the option '{}' is of PBRT's program and ignored", p.name));
  if (in_->peek() && in_->peek()->type == TokenType::word) return;
  if (in_->peek() && in_->peek()->type != TokenType::word)
    throw InputError(token.where, "Option takes \"type name\" and a value");
}

void Reader::reverseOrientation(const Token&) {
  state_.reverseOrientation = !state_.reverseOrientation;
}

// One name stands for both sides.
void Reader::mediumInterface(const Token& token) {
  state_.mediumInside = quoted(token, "medium");
  state_.mediumOutside = state_.mediumInside;
  if (in_->peek() && in_->peek()->type == TokenType::string)
    state_.mediumOutside = in_->next()->text;
}

void Reader::makeNamedMedium(const Token& token) {
  const std::string name = quoted(token, "name");
  Parameters in = parameters(token, "medium");
  const std::string type = in.string("type", "homogeneous");
  Medium medium;
  if (type == "homogeneous" && !in.has("preset") && !in.has("Le")) {
    const Rgb scatter =
        color(in, "sigma_s", SpectrumUse::unbounded).value_or(Rgb(2.55f, 3.21f, 3.77f));
    medium.absorption =
        color(in, "sigma_a", SpectrumUse::unbounded).value_or(Rgb(.0011f, .0024f, .014f)) *
        in.number("scale", 1.f);
    medium.isAbsorbing = maxComponent(scatter) <= 0;
    in.ignore({"g"});
    in.finish("medium", findings_);
  }
  if (!medium.isAbsorbing) {
    findings_.warn(token.where,
                   fmt::format("the medium '{}' is not supported and left out: of participating "
                               "media only those inside of glass that absorb and do not scatter "
                               "are; surfaces around it are kept",
                               name));
  }
  media_[name] = medium;
}

}  // namespace lobelia::io::pbrt
