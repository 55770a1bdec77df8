// Designs: small files of changes to a scene, of any format, that are applied when it is read.
//
// A design is a Mitsuba scene without shapes; what it has takes the place of what the scene has:
//  - <bsdf id="NAME">: the material of that name;
//  - <emitter>: an environment (constant, envmap, sky) that of the scene (the first, of several); a
//    sun that of the scene; others the emitter that has their id as its name (area emitters their
//    radiance), or a new one;
//  - <sensor>: the camera of its id, or a new one that is the first. Without a <film>, the picture
//    stays as large as it was.
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

}  // namespace lobelia::io
