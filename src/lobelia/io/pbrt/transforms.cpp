// The current transformation. Transforms of moving scenes have two, for the shutter's start and its
// end; the start's is kept.
#include <fmt/format.h>

#include "lobelia/io/pbrt/reader.h"

namespace lobelia::io::pbrt {
namespace {

// PBRT writes matrices column by column.
Mat4 fromColumns(const std::vector<double>& n) {
  Mat4 m;
  for (size_t i = 0; i < 16; ++i) m.m[i % 4][i / 4] = n[i];
  return m;
}

}  // namespace

// Brackets around the numbers are allowed everywhere.
std::vector<double> Reader::numbers(const Token& directive, size_t count) {
  std::vector<double> out;
  const auto fail = [&] {
    throw InputError(directive.where, fmt::format("{} takes {} numbers", directive.text, count));
  };
  bool bracket = false;
  while (out.size() < count) {
    const std::optional<Token> token = in_->next();
    if (!token) fail();
    if (token->type == TokenType::open && !bracket && out.empty()) {
      bracket = true;
    } else if (token->type == TokenType::word) {
      out.push_back(parseNumber(token->text, token->where));
    } else {
      fail();
    }
  }
  if (bracket) {
    const std::optional<Token> token = in_->next();
    if (!token || token->type != TokenType::close) fail();
  }
  return out;
}

void Reader::concatenate(const Token& directive, const Mat4& matrix, bool replace) {
  const Mat4 next = replace || !state_.atStart ? matrix : state_.ctm * matrix;
  if (!matrix.isFinite() || !inverse(matrix) || !inverse(next)) {
    throw InputError(directive.where,
                     fmt::format("{} gives a matrix without an inverse", directive.text));
  }
  if (state_.atStart) state_.ctm = next;
}

void Reader::identity(const Token& token) { concatenate(token, Mat4(), true); }

void Reader::translate(const Token& token) {
  const std::vector<double> n = numbers(token, 3);
  concatenate(token, translation({n[0], n[1], n[2]}));
}

void Reader::scale(const Token& token) {
  const std::vector<double> n = numbers(token, 3);
  concatenate(token, scaling({n[0], n[1], n[2]}));
}

void Reader::rotate(const Token& token) {
  const std::vector<double> n = numbers(token, 4);
  concatenate(token, rotation({n[1], n[2], n[3]}, n[0]));
}

// PBRT's x is up times direction as in lookAt() of base, where that is the left: PBRT's world is
// left-handed, and makeCamera() puts +x on the right.
void Reader::lookAt(const Token& token) {
  const std::vector<double> n = numbers(token, 9);
  const std::optional<Mat4> toWorld =
      lobelia::lookAt({n[0], n[1], n[2]}, {n[3], n[4], n[5]}, {n[6], n[7], n[8]});
  if (!toWorld || !inverse(*toWorld)) {
    throw InputError(token.where,
                     "LookAt has no direction, or its up vector lies along it; it takes eye, "
                     "target and up");
  }
  concatenate(token, *inverse(*toWorld));
}

void Reader::transform(const Token& token) {
  concatenate(token, fromColumns(numbers(token, 16)), true);
}

void Reader::concatTransform(const Token& token) {
  concatenate(token, fromColumns(numbers(token, 16)));
}

void Reader::coordinateSystem(const Token& token) {
  coordinateSystems_[quoted(token, "name")] = state_.ctm;
}

void Reader::coordSysTransform(const Token& token) {
  const std::string name = quoted(token, "name");
  const auto found = coordinateSystems_.find(name);
  if (found != coordinateSystems_.end()) return concatenate(token, found->second, true);
  std::vector<std::string> known;
  for (const auto& [other, matrix] : coordinateSystems_) known.push_back(other);
  findings_.warn(token.where, unknownName("coordinate system", name, known) + "; ignored");
}

void Reader::activeTransform(const Token& token) {
  const std::optional<Token> which = in_->next();
  const std::string name = which ? which->text : "";
  if (name != "StartTime" && name != "EndTime" && name != "All") {
    throw InputError(token.where, fmt::format("ActiveTransform is '{}'; it may be StartTime, "
                                              "EndTime or All",
                                              name));
  }
  state_.atStart = name != "EndTime";
  state_.atEnd = name != "StartTime";
  if (name != "All")
    warnOnce(token.where, "motion is not supported; the scene stands as it is at the start");
}

void Reader::transformTimes(const Token& token) {
  numbers(token, 2);
  warnOnce(token.where, "motion is not supported; the scene stands as it is at the start");
}

Transform Reader::placement(const Mat4& matrix, const Location& where) const {
  if (!inverse(matrix)) throw InputError(where, "the transform here has no inverse");
  return Transform(matrix);
}

}  // namespace lobelia::io::pbrt
