// From options and a scene to a camera and an empty film, and from a film to files.
#pragma once

#include "lobelia/app/render_options.h"
#include "lobelia/film/film.h"
#include "lobelia/path/path_tracer.h"

namespace lobelia::app {

Camera chooseCamera(const Scene& scene, const RenderOptions& options);
PixelSet choosePixels(const Camera& camera, const RenderOptions& options);
// What --aov may name.
const std::vector<std::string>& knownLayers();
// Layers: "direct" and "indirect" always (the picture is their sum), others as --aov says.
Film makeFilm(const Camera& camera, const RenderOptions& options);
// Fills the picture from "direct" and "indirect" as --component says; drops layers not asked for.
void composePicture(Film& film, const RenderOptions& options);
// Checks before hours are spent: known extensions, folders that exist and can be written.
void requireWritable(const std::string& file);
void requireOutputs(const RenderOptions& options);
void writeOutputs(const Film& film, const RenderOptions& options, Context& context);

}  // namespace lobelia::app
