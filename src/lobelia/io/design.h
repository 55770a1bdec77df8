// Designs: small files of changes to a scene, of any format, that are applied when it is read.
//
// A design is a Mitsuba scene without shapes; what it has takes the place of what the scene has:
//  - <bsdf id="NAME">: the material of that name; a <ref id="NAME"/> inside it, where nothing in
//    the design is called so, is the scene's material of that name;
//  - <emitter>: an environment (constant, envmap, sky) that of the scene (the first, of several); a
//    sun that of the scene; others the emitter that has their id as its name (area emitters their
//    radiance), or a new one;
//  - <sensor>: the camera of its id, or a new one that is the first. Without a <film>, the picture
//    stays as large as it was.
//
// What has no name, or one that others have too, is called by its place in the scene, counted from
// 0: "material[7]", "emitter[0]", "camera[1]". Names go before such.
#pragma once

#include "lobelia/io/scene_io.h"

namespace lobelia::io {

// What a design has.
struct DesignParts {
  bool materials = false, emitters = false, cameras = false;
};
// Throws InputError: a file that cannot be read, one with shapes, a material without or with an
// unknown name, an area emitter that the scene does not have. Warnings go to Scene::findings.
DesignParts applyDesign(const std::string& file, const ReadSettings& settings, Scene& scene,
                        Context& context);

// Writes what `now` has otherwise than `before`: materials, emitters, cameras. applyDesign() on
// `before` makes the same of it, bit for bit. `before`: the scene as read, of which textures and
// images need not be there; `now`: with all of them, the first of each those of `before`. Images
// are named where they came from, relative to the file, when they are read as the same from there;
// others are written into a folder beside it (FILE without suffix, "_textures"). Throws
// RuntimeError; then the file is as it was.
void writeDesign(const std::string& file, const Scene& before, const Scene& now);

// The names of materials that are others in `now`. What is wrapped, textures
// and images are the same when their handles are; names do not count.
std::vector<std::string> changedMaterials(const std::vector<Material>& before,
                                          const std::vector<Material>& now);

// What a design calls them.
std::string designName(const std::vector<Material>& materials, size_t index);
std::string designName(const std::vector<Emitter>& emitters, size_t index);
std::vector<std::string> designNames(const std::vector<Material>& materials);  // all at once
std::vector<std::string> designNames(const std::vector<Emitter>& emitters);
// Those that a design's id names: all of that name, or the one of that place; empty: none.
std::vector<size_t> namedInDesign(const std::vector<Material>& materials, const std::string& id);
std::vector<size_t> namedInDesign(const std::vector<Emitter>& emitters, const std::string& id);
std::vector<size_t> namedInDesign(const std::vector<Camera>& cameras, const std::string& id);

}  // namespace lobelia::io
