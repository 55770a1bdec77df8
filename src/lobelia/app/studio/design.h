// What a person changes of a scene: materials, textures, emitters, the turn of the light from
// infinity. A value that is copied as a whole; designs are kept by a History.
//
// Indices below the scene's counts are those of the scene; what edits add stands behind them and
// goes again when nothing refers to it (compact()). Images are large and shared between designs.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "lobelia/scene/scene.h"

namespace lobelia::app {

// An image that a design brings. Any thread may read its name and size; `pixels` belong to whoever
// renders: a Stage takes them into its scene while a design of them is shown, and gives them back.
struct StoredImage {
  const std::string name;  // the file it came from
  const size_t bytes;
  Image pixels;
  explicit StoredImage(Image image)
      : name(image.name), bytes(image.pixels.size() * sizeof(float)), pixels(std::move(image)) {}
};

struct Design {
  std::vector<Material> materials;
  std::vector<Texture> textures;
  std::vector<Emitter> emitters;
  std::vector<Camera> cameras;  // the scene's; where a person looks from is no part of a design
  std::vector<std::shared_ptr<StoredImage>> images;  // of index sceneImages and more
  double rotation = 0;  // of light from infinity, degrees about the environment's vertical axis

  // How many the scene has.
  uint32_t sceneMaterials = 0, sceneTextures = 0, sceneImages = 0, sceneEmitters = 0;
};

Design designOf(const Scene& scene);
// What readers and writers of designs need: a scene without meshes and pixels.
Scene sceneOf(const Design& design);

// Adds an image and a bitmap of it. raw: its numbers are values (height, normals, opacity), which
// is said by how it was read already; the texture is the same.
TextureHandle addBitmap(Design& design, std::shared_ptr<StoredImage> image);

// Lets go of added materials, textures and images to which nothing leads.
void compact(Design& design);

// Emitters with light from infinity turned about the vertical of the first environment (else +y).
std::vector<Emitter> turnedEmitters(const Design& design, double degrees);

// Is it the same light, whatever textures are? False where an emitter has one.
bool sameLight(const std::vector<Emitter>& a, const std::vector<Emitter>& b);

// Of materials and their textures, images by number.
uint64_t materialsHash(const Design& design);

// Of many names, the first, in quotes.
std::string someOf(const std::vector<std::string>& names);

// About how many bytes a copy takes, images left out.
size_t sizeOf(const Design& design);

}  // namespace lobelia::app
