// Locations as text, and the nearest known name to a misspelt one.
#include "lobelia/base/error.h"

#include <algorithm>
#include <cctype>

namespace lobelia {
namespace {

char lower(char c) { return static_cast<char>(std::tolower(static_cast<unsigned char>(c))); }

// Edits (insert, delete, replace, swap of neighbours) from a to b, ignoring case.
size_t editDistance(std::string_view a, std::string_view b) {
  std::vector<size_t> before(b.size() + 1), previous(b.size() + 1), row(b.size() + 1);
  for (size_t j = 0; j <= b.size(); ++j) previous[j] = j;
  for (size_t i = 1; i <= a.size(); ++i) {
    row[0] = i;
    for (size_t j = 1; j <= b.size(); ++j) {
      const bool same = lower(a[i - 1]) == lower(b[j - 1]);
      row[j] = std::min({previous[j] + 1, row[j - 1] + 1, previous[j - 1] + (same ? 0 : 1)});
      const bool swapped = i > 1 && j > 1 && lower(a[i - 1]) == lower(b[j - 2]) &&
                           lower(a[i - 2]) == lower(b[j - 1]);
      if (swapped) row[j] = std::min(row[j], before[j - 2] + 1);
    }
    std::swap(before, previous);
    std::swap(previous, row);
  }
  return previous[b.size()];
}

}  // namespace

std::string toString(const Location& where) {
  std::string text = where.file;
  if (where.line > 0) {
    text += ':';
    text += std::to_string(where.line);
    if (where.column > 0) {
      text += ':';
      text += std::to_string(where.column);
    }
  }
  return text;
}

std::string suggestion(std::string_view name, const std::vector<std::string>& known) {
  // Names from a corrupt file may be long; none of ours is.
  if (name.empty() || name.size() > 200) return "";
  const std::string* best = nullptr;
  // The first word of a name, as in 'sglc' for 'sglc-shared', whatever follows.
  const auto begun = [&](const std::string& candidate) {
    return candidate.size() > name.size() && candidate.starts_with(name) &&
           candidate[name.size()] == '-';
  };
  size_t bestDistance = 0;
  for (const std::string& candidate : known) {
    const size_t distance = begun(candidate) ? 0 : editDistance(name, candidate);
    if (!best || distance < bestDistance) best = &candidate, bestDistance = distance;
  }
  // Near: up to two fifths of the longer name may differ.
  if (!best || bestDistance * 5 > std::max(name.size(), best->size()) * 2) return "";
  std::string text = "; did you mean '";
  text += *best;
  text += "'?";
  return text;
}

}  // namespace lobelia
