#include "lobelia/app/viewer/window/picture_texture.h"

#include <cstdint>

namespace lobelia::app {

PictureTexture::PictureTexture(const GlFunctions& gl) : gl_(gl) {
  gl_.genTextures(1, &name_);
  gl_.bindTexture(GL_TEXTURE_2D, name_);
  gl_.texParameteri(GL_TEXTURE_2D, GL_TEXTURE_MIN_FILTER, GL_LINEAR);
  // A picture of half the size is enlarged; squares would look like an error.
  gl_.texParameteri(GL_TEXTURE_2D, GL_TEXTURE_MAG_FILTER, GL_LINEAR);
  gl_.texParameteri(GL_TEXTURE_2D, GL_TEXTURE_WRAP_S, GL_CLAMP_TO_EDGE);
  gl_.texParameteri(GL_TEXTURE_2D, GL_TEXTURE_WRAP_T, GL_CLAMP_TO_EDGE);
}

PictureTexture::~PictureTexture() { gl_.deleteTextures(1, &name_); }

bool PictureTexture::fill(int width, int height, std::span<const uint8_t> rgba) {
  if (width <= 0 || height <= 0 ||
      rgba.size() != static_cast<size_t>(width) * static_cast<size_t>(height) * 4)
    return true;                                                  // nothing to show
  for (int i = 0; i < 16 && gl_.getError() != GL_NO_ERROR;) ++i;  // of others, before
  gl_.bindTexture(GL_TEXTURE_2D, name_);
  gl_.pixelStorei(GL_UNPACK_ALIGNMENT, 1);
  gl_.pixelStorei(GL_UNPACK_ROW_LENGTH, 0);
  if (width == width_ && height == height_) {
    gl_.texSubImage2D(GL_TEXTURE_2D, 0, 0, 0, width, height, GL_RGBA, GL_UNSIGNED_BYTE,
                      rgba.data());
  } else {
    gl_.texImage2D(GL_TEXTURE_2D, 0, GL_RGBA8, width, height, 0, GL_RGBA, GL_UNSIGNED_BYTE,
                   rgba.data());
  }
  const bool taken = gl_.getError() == GL_NO_ERROR;
  width_ = taken ? width : 0;
  height_ = taken ? height : 0;
  return taken;
}

void* PictureTexture::id() const { return reinterpret_cast<void*>(static_cast<uintptr_t>(name_)); }

}  // namespace lobelia::app
