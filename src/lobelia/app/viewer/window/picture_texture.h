// A picture of 8-bit RGBA as a texture, shown pixel for pixel.
#pragma once

#include <cstdint>
#include <span>

#include "lobelia/app/viewer/window/gl_functions.h"

namespace lobelia::app {

// Belongs to the context that is current when it is made, filled and destroyed.
class PictureTexture {
 public:
  explicit PictureTexture(const GlFunctions& gl);
  ~PictureTexture();
  PictureTexture(const PictureTexture&) = delete;
  PictureTexture& operator=(const PictureTexture&) = delete;

  // rgba: width * height * 4 bytes, the top row first. False when OpenGL would not take it (out of
  // its memory, or the context is lost); the texture is empty then.
  bool fill(int width, int height, std::span<const uint8_t> rgba);
  // What was filled in; 0: nothing.
  int width() const { return width_; }
  int height() const { return height_; }
  // Dear ImGui's name for it.
  void* id() const;

 private:
  const GlFunctions& gl_;
  unsigned name_ = 0;
  int width_ = 0, height_ = 0;
};

}  // namespace lobelia::app
