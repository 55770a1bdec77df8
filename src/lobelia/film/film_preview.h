// Who looks at a picture while it is made.
#pragma once

#include <cstdint>
#include <span>

#include "lobelia/base/vec.h"

namespace lobelia {

class FilmPreview {
 public:
  virtual ~FilmPreview() = default;
  // The picture's values at pixels (indices into the data window) as they stand: means of the
  // samples so far. Cheap; from any thread.
  virtual void update(std::span<const uint32_t> pixels, std::span<const Rgb> values) = 0;
  // Whether new values would be looked at now: true some times a second, for methods to which a
  // look at the whole film is work. From any thread.
  virtual bool due() const = 0;
};

}  // namespace lobelia
