// From options and a scene to a camera and an empty film, and from a film to files.
#pragma once

#include <optional>
#include <vector>

#include "lobelia/app/render_options.h"
#include "lobelia/film/film.h"
#include "lobelia/path/path_tracer.h"

namespace lobelia::app {

// Throws UsageError where --size, --crop or --aov is misspelt, whatever the scene.
void requirePicture(const RenderOptions& options);
void requireSize(const std::string& size);  // "": none is asked for
// The cameras that --camera names, with the film that --size and --crop ask for.
std::vector<Camera> chooseCameras(const Scene& scene, const RenderOptions& options);
// Throws UsageError when it names several.
Camera chooseCamera(const Scene& scene, const RenderOptions& options);
PixelSet choosePixels(const Camera& camera, const RenderOptions& options);
// What --aov may name.
const std::vector<std::string>& knownLayers();
std::vector<std::string> requestedLayers(const RenderOptions& options);
// Layers: "direct" and "indirect" always (the picture is their sum), others as --aov says (but for
// those of addLightLayers(), light_layers.h).
Film makeFilm(const Camera& camera, const RenderOptions& options);
// Fills the picture from "direct" and "indirect" as --component says; drops layers not asked for.
void composePicture(Film& film, const RenderOptions& options);
// Checks before hours are spent: known extensions, files that can be made where they belong.
void requireWritable(const std::string& file);
// The same for a folder of files, which is made where it is not there yet.
void requireWritableFolder(const std::string& folder);
void requireOutputs(const RenderOptions& options);
// Throws UsageError where a file would be written over one that is read. "" is no file.
void requireNoInput(const std::vector<std::string>& outputs,
                    const std::vector<std::string>& inputs);
// curve: how PNG files are tone-mapped; empty: measured on this film, and kept for later ones.
void writeOutputs(const Film& film, const RenderOptions& options, std::optional<ToneCurve>& curve,
                  Context& context);

}  // namespace lobelia::app
