#include "lobelia/app/frame_setup.h"

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <filesystem>

#include "lobelia/base/file.h"
#include "lobelia/io/image_io.h"

namespace lobelia::app {
namespace {

// Integers separated by one character, exactly N of them.
template <size_t N>
std::array<int, N> parseIntegers(const std::string& text, char separator, const char* option,
                                 const char* form) {
  std::array<int, N> out{};
  const char* p = text.data();
  const char* end = p + text.size();
  for (size_t i = 0; i < N; ++i) {
    const auto [next, error] = std::from_chars(p, end, out[i]);
    const bool last = i + 1 == N;
    if (error != std::errc() || (last ? next != end : next == end || *next != separator)) {
      throw UsageError(fmt::format("{} '{}' is not of the form {}", option, text, form));
    }
    p = next + 1;
  }
  return out;
}

// Memory that the machine does not have is given all the same by most systems, and the program
// killed without a word when it is used.
void requireMemory(const Camera& camera, size_t channels) {
  const double width = camera.cropX1 - camera.cropX0, height = camera.cropY1 - camera.cropY0;
  const double needed = width * height * static_cast<double>(channels * sizeof(float));
  const double present =
      static_cast<double>(sysconf(_SC_PHYS_PAGES)) * static_cast<double>(sysconf(_SC_PAGESIZE));
  if (needed <= present) return;
  constexpr double kGiB = 1 << 30;
  throw RuntimeError(fmt::format(
      "a picture of {} x {} pixels needs {:.0f} GiB and the machine has {:.0f}; lower --size, or "
      "render parts of it with --crop",
      width, height, needed / kGiB, present / kGiB));
}

}  // namespace

const std::vector<std::string>& knownLayers() {
  static const std::vector<std::string> names{"albedo",   "normal",   "depth",    "direct",
                                              "indirect", "specular", "variance", "groups",
                                              "types",    "cost"};
  return names;
}

std::vector<std::string> requestedLayers(const RenderOptions& options) {
  std::vector<std::string> out;
  size_t begin = 0;
  while (begin < options.aovs.size()) {
    const size_t end = std::min(options.aovs.find(',', begin), options.aovs.size());
    const std::string name = options.aovs.substr(begin, end - begin);
    if (std::find(knownLayers().begin(), knownLayers().end(), name) == knownLayers().end()) {
      throw UsageError(fmt::format("--aov '{}' is not known; there are {}{}", name,
                                   fmt::join(knownLayers(), ", "),
                                   suggestion(name, knownLayers())));
    }
    out.push_back(name);
    begin = end + 1;
  }
  return out;
}

namespace {

// "" is the first.
Camera findCamera(const Scene& scene, const std::string& wanted) {
  if (wanted.empty()) return scene.cameras.front();
  const Camera* found = nullptr;
  std::vector<std::string> names;
  for (size_t i = 0; i < scene.cameras.size(); ++i) {
    const Camera& camera = scene.cameras[i];
    names.push_back(camera.name.empty() ? std::to_string(i) : camera.name);
    if (wanted == camera.name || wanted == std::to_string(i)) found = &camera;
  }
  if (found != nullptr) return *found;
  throw UsageError(fmt::format("--camera '{}' is not in the scene; there are {}{}", wanted,
                               fmt::join(names, ", "), suggestion(wanted, names)));
}

// A name may have commas: the whole is tried first.
std::vector<Camera> findCameras(const Scene& scene, const std::string& wanted) {
  const bool whole = std::any_of(scene.cameras.begin(), scene.cameras.end(),
                                 [&](const Camera& camera) { return camera.name == wanted; });
  if (whole || wanted.empty()) return {findCamera(scene, wanted)};
  std::vector<Camera> cameras;
  for (size_t begin = 0; begin <= wanted.size();) {
    const size_t end = std::min(wanted.find(',', begin), wanted.size());
    if (end == begin) {
      throw UsageError(fmt::format("--camera '{}': names are separated by single commas", wanted));
    }
    cameras.push_back(findCamera(scene, wanted.substr(begin, end - begin)));
    begin = end + 1;
  }
  return cameras;
}

std::array<int, 2> parseSize(const std::string& text) {
  const std::array<int, 2> size = parseIntegers<2>(text, 'x', "--size", "WxH, as in 640x480");
  const auto [width, height] = size;
  if (width < 1 || height < 1 || width > 65536 || height > 65536)
    throw UsageError(fmt::format("--size {}: sides go from 1 to 65536 pixels", text));
  constexpr int64_t kMaxPixels = 1 << 28;
  if (int64_t{width} * height > kMaxPixels)
    throw UsageError(fmt::format("--size {}: more than 2^28 pixels", text));
  return size;
}

// X0,Y0,X1,Y1; whether they lie within the picture shows with the camera.
std::array<int, 4> parseCrop(const std::string& text) {
  const std::array<int, 4> crop = parseIntegers<4>(text, ',', "--crop", "X0,Y0,X1,Y1");
  const auto [x0, y0, x1, y1] = crop;
  if (x0 < 0 || y0 < 0 || x1 <= x0 || y1 <= y0)
    throw UsageError(fmt::format("--crop {}: X0 is from 0 and less than X1, and so is Y0", text));
  return crop;
}

Camera withFilm(Camera camera, const RenderOptions& options) {
  if (!options.size.empty()) {
    const auto [width, height] = parseSize(options.size);
    camera.width = width;
    camera.height = height;
    camera.cropX0 = camera.cropY0 = camera.cropX1 = camera.cropY1 = 0;
  }
  if (!options.crop.empty()) {
    const auto [x0, y0, x1, y1] = parseCrop(options.crop);
    if (x1 > camera.width || y1 > camera.height) {
      throw UsageError(fmt::format("--crop {} is not a window within {}x{}", options.crop,
                                   camera.width, camera.height));
    }
    camera.cropX0 = x0, camera.cropY0 = y0, camera.cropX1 = x1, camera.cropY1 = y1;
  }
  if (camera.cropX1 == 0) {
    camera.cropX1 = camera.width;
    camera.cropY1 = camera.height;
  }
  return camera;
}

}  // namespace

void requirePicture(const RenderOptions& options) {
  requireSize(options.size);
  if (!options.crop.empty()) parseCrop(options.crop);
  requestedLayers(options);
}

void requireSize(const std::string& size) {
  if (!size.empty()) parseSize(size);
}

std::vector<Camera> chooseCameras(const Scene& scene, const RenderOptions& options) {
  std::vector<Camera> cameras = findCameras(scene, options.camera);
  for (Camera& camera : cameras) camera = withFilm(camera, options);
  return cameras;
}

Camera chooseCamera(const Scene& scene, const RenderOptions& options) {
  std::vector<Camera> cameras = chooseCameras(scene, options);
  if (cameras.size() > 1) {
    throw UsageError(fmt::format(
        "--camera '{}' is a path through several cameras; say in how many frames with --frames N",
        options.camera));
  }
  return std::move(cameras.front());
}

PixelSet choosePixels(const Camera& camera, const RenderOptions& options) {
  if (options.pixels == 0) return {};
  const int width = camera.cropX1 - camera.cropX0, height = camera.cropY1 - camera.cropY0;
  const size_t all = static_cast<size_t>(width) * static_cast<size_t>(height);
  if (options.pixels >= all) return {};
  return spreadPixels(width, height, options.pixels, options.pixelsSeed.value_or(options.seed));
}

Film makeFilm(const Camera& camera, const RenderOptions& options) {
  Film film;
  film.fullWidth = camera.width;
  film.fullHeight = camera.height;
  film.x0 = camera.cropX0;
  film.y0 = camera.cropY0;
  film.width = camera.cropX1 - camera.cropX0;
  film.height = camera.cropY1 - camera.cropY0;
  const std::vector<std::string> layers = requestedLayers(options);
  requireMemory(camera, 3 * (3 + layers.size()));
  film.addLayer("");
  film.addLayer("direct");
  film.addLayer("indirect");
  for (const std::string& name : layers) {
    if (name == "groups" || name == "types" || name == "cost") continue;  // addLightLayers()
    film.addLayer(name, name == "depth" ? 1 : 3);
  }
  return film;
}

void composePicture(Film& film, const RenderOptions& options) {
  const std::vector<float>& direct = film.layers.at("direct").values;
  const std::vector<float>& indirect = film.layers.at("indirect").values;
  std::vector<float>& picture = film.layers.at("").values;
  const float d = options.component == "indirect" ? 0.f : 1.f;
  const float i = options.component == "direct" ? 0.f : 1.f;
  for (size_t k = 0; k < picture.size(); ++k) {
    // Not 0 * x, which would turn a non-finite value of the other part into one of this.
    picture[k] = (d > 0 ? direct[k] : 0) + (i > 0 ? indirect[k] : 0);
  }
  const std::vector<std::string> wanted = requestedLayers(options);
  for (const char* name : {"direct", "indirect"}) {
    if (std::find(wanted.begin(), wanted.end(), name) == wanted.end()) film.layers.erase(name);
  }
}

void requireWritable(const std::string& file) {
  namespace fs = std::filesystem;
  const fs::path path(file);
  const fs::path folder = path.has_parent_path() ? path.parent_path() : fs::path(".");
  std::error_code error;
  if (!fs::is_directory(folder, error)) {
    throw UsageError(fmt::format("cannot write {}: there is no folder {}", file, folder.string()));
  }
  if (fs::is_directory(path, error))
    throw UsageError(fmt::format("cannot write {}: it is a folder", file));
  if (const std::string why = whyNotWritable(file); !why.empty())
    throw UsageError(fmt::format("cannot write {}: {}", file, why));
}

void requireWritableFolder(const std::string& folder) {
  namespace fs = std::filesystem;
  std::error_code error;
  // What is missing of the path will be made.
  fs::path there = fs::absolute(folder);
  while (!fs::exists(there, error) && there.has_relative_path()) there = there.parent_path();
  if (!fs::is_directory(there, error))
    throw UsageError(
        fmt::format("cannot write into {}: {} is not a folder", folder, there.string()));
  if (const std::string why = whyNotWritable((there / "scene.xml").string()); !why.empty())
    throw UsageError(fmt::format("cannot write into {}: {}", folder, why));
}

void requireOutputs(const RenderOptions& options) {
  if (options.outputs.empty() && options.replay.empty()) {
    throw UsageError("--output is required: the picture to write, as in -o picture.exr");
  }
  for (const std::string& file : options.outputs) {
    const std::string extension = std::filesystem::path(file).extension().string();
    if (extension != ".exr" && extension != ".png") {
      throw UsageError(fmt::format("-o {}: pictures are written as .exr or .png", file));
    }
    requireWritable(file);
  }
  std::vector<std::string> files = options.outputs;
  for (const std::string& file :
       {options.stats, options.saveLights, options.checkpoint, options.resume}) {
    if (file.empty()) continue;
    requireWritable(file);
    files.push_back(file);
  }
  for (std::string& file : files) {  // "a.exr" and "./a.exr" are one
    std::error_code error;
    const std::filesystem::path whole = std::filesystem::weakly_canonical(file, error);
    if (!error) file = whole.string();
  }
  std::sort(files.begin(), files.end());
  if (const auto twice = std::adjacent_find(files.begin(), files.end()); twice != files.end()) {
    throw UsageError(
        fmt::format("{} would be written twice; give each output its own name", *twice));
  }
}

void writeOutputs(const Film& film, const RenderOptions& options, std::optional<ToneCurve>& curve,
                  Context& context) {
  for (const std::string& file : options.outputs) {
    if (std::filesystem::path(file).extension() == ".exr") {
      io::writeExr(file, film);
    } else {
      if (!curve) curve = measureToneCurve(film, {.exposure = options.exposure});
      io::writePng(file, toneMap(film, *curve), film.width, film.height);
    }
    context.info(fmt::format("wrote {}", file));
  }
}

void requireNoInput(const std::vector<std::string>& outputs,
                    const std::vector<std::string>& inputs) {
  for (const std::string& output : outputs)
    for (const std::string& input : inputs) {
      std::error_code none;
      if (output.empty() || input.empty() || !std::filesystem::is_regular_file(input, none))
        continue;
      if (std::filesystem::equivalent(output, input, none))
        throw UsageError(fmt::format("'{}' would be written over what is read", output));
    }
}

}  // namespace lobelia::app
