// The options block: camera, film, filter, and the hints of sampler and integrator.
//
// PBRT's camera space has x to the right, ours to the left. The field of view is that of the
// shorter side. Deviations: Gaussian filters are cut at four standard deviations, PBRT's at their
// radius (1.5, three of the default's); sinc filters are Lanczos filters with as many lobes as the
// radius; the response curves of real sensors are not modelled, only their exposure.
#include <fmt/format.h>

#include <cmath>

#include "lobelia/io/pbrt/reader.h"

namespace lobelia::io::pbrt {
namespace {

constexpr int kMaxFilmSide = 1 << 17;
constexpr int64_t kMaxFilmPixels = int64_t{1} << 28;
constexpr float kNear = 1e-4f, kFar = 1e7f;  // PBRT has no clip planes

struct Window {
  double x0, x1, y0, y1;
  double width() const { return x1 - x0; }
  double height() const { return y1 - y0; }
};

// The part of the screen plane that the film sees.
Window screenWindow(Parameters& in, double filmAspect) {
  const double aspect = in.number("frameaspectratio").value_or(filmAspect);
  if (!(aspect > 0)) throw InputError(in.where(), "the frameaspectratio must be above 0");
  Window w = aspect > 1 ? Window{-aspect, aspect, -1, 1} : Window{-1, 1, -1 / aspect, 1 / aspect};
  const std::vector<double> given = in.numbers("screenwindow");
  if (!given.empty()) {
    if (given.size() != 4 || !(given[0] < given[1]) || !(given[2] < given[3]))
      throw InputError(in.where(),
                       "the screenwindow takes four numbers: x from, x to, y from, y to");
    w = {given[0], given[1], given[2], given[3]};
  }
  return w;
}

bool contains(const std::vector<std::string>& names, const std::string& name) {
  return std::find(names.begin(), names.end(), name) != names.end();
}

void readCrop(Parameters& in, Camera& camera) {
  const std::vector<double> window = in.numbers("cropwindow"), bounds = in.numbers("pixelbounds");
  if (window.empty() && bounds.empty()) return;
  std::vector<double> b = bounds;
  if (bounds.empty() && window.size() == 4) {
    const double width = camera.width, height = camera.height;
    b = {std::ceil(width * window[0]), std::ceil(width * window[1]), std::ceil(height * window[2]),
         std::ceil(height * window[3])};
  }
  if (b.size() != 4 || !(b[0] >= 0 && b[0] < b[1] && b[1] <= camera.width) ||
      !(b[2] >= 0 && b[2] < b[3] && b[3] <= camera.height)) {
    throw InputError(in.where(),
                     fmt::format("the crop is not inside of the film of {} x {} pixels; it takes "
                                 "x from, x to, y from, y to",
                                 camera.width, camera.height));
  }
  camera.cropX0 = static_cast<int>(b[0]), camera.cropX1 = static_cast<int>(b[1]);
  camera.cropY0 = static_cast<int>(b[2]), camera.cropY1 = static_cast<int>(b[3]);
}

}  // namespace

void Reader::camera(const Token& token) {
  if (!cameraType_.empty()) findings_.warn(token.where, "a second Camera; the last one counts");
  cameraType_ = quoted(token, "type");
  const std::vector<std::string> known{"perspective", "orthographic"};
  if (!contains(known, cameraType_)) {
    if (cameraType_ == "realistic" || cameraType_ == "spherical")
      throw InputError(token.where, fmt::format("the camera '{}' is not supported; perspective and "
                                                "orthographic are",
                                                cameraType_));
    throw InputError(token.where, unknownName("camera", cameraType_, known));
  }
  cameraParameters_ = parameters(token);
  cameraFromWorld_ = state_.ctm;
  coordinateSystems_["camera"] = *inverse(state_.ctm);
  if (!state_.mediumOutside.empty())
    findings_.warn(token.where, "the camera stands in a medium, which is not supported");
}

void Reader::film(const Token& token) {
  const std::string type = quoted(token, "type");
  const std::vector<std::string> known{"rgb", "gbuffer", "spectral"};
  if (!contains(known, type))
    findings_.warn(token.where, unknownName("film", type, known) + "; read as rgb");
  filmParameters_ = parameters(token);
  hasFilm_ = true;
  Parameters& in = filmParameters_;
  camera_.width = in.integer("xresolution", 1280);
  camera_.height = in.integer("yresolution", 720);
  if (camera_.width < 1 || camera_.height < 1 || camera_.width > kMaxFilmSide ||
      camera_.height > kMaxFilmSide || int64_t{camera_.width} * camera_.height > kMaxFilmPixels) {
    throw InputError(token.where, fmt::format("the film's size {} x {} is impossible; at least "
                                              "1 x 1, at most 2^28 pixels",
                                              camera_.width, camera_.height));
  }
  readCrop(in, camera_);
  const std::string sensor = in.string("sensor", "cie1931");
  if (sensor != "cie1931")
    findings_.warn(token.where, fmt::format("the colours of the sensor '{}' are not modelled, only "
                                            "its exposure",
                                            sensor));
  imagingRatio_ = in.number("iso", 100.f) * in.number("exposuretime", 1.f) / 100;
  if (!(imagingRatio_ > 0) || !std::isfinite(imagingRatio_))
    throw InputError(token.where, "iso and exposuretime must be above 0");
  if (in.number("whitebalance", 0.f) != 0)
    findings_.warn(token.where, "'whitebalance' is not supported; colours stay as they are");
  in.ignore({"filename", "diagonal", "savefp16", "maxcomponentvalue", "coordinatesystem",
             "nbuckets", "lambdamin", "lambdamax"});
  in.finish("film", findings_);
}

void Reader::pixelFilter(const Token& token) {
  const std::string type = quoted(token, "type");
  Parameters in = parameters(token);
  const auto radius = [&](float otherwise) {
    const float x = in.number("xradius", otherwise), y = in.number("yradius", otherwise);
    if (!(x > 0 && y > 0 && x <= 64))
      throw InputError(token.where, "the filter's radius must be above 0 and at most 64");
    if (x != y) findings_.warn(token.where, "the filter's yradius is taken to be its xradius");
    return x;
  };
  if (type == "box") {
    camera_.filter = PixelFilter::box;
    camera_.filterRadius = radius(0.5f);
  } else if (type == "triangle") {
    camera_.filter = PixelFilter::tent;
    camera_.filterRadius = radius(2.f);
  } else if (type == "gaussian") {
    camera_.filter = PixelFilter::gaussian;
    radius(1.5f);
    const float sigma = in.number("sigma", 0.5f);
    if (!(sigma > 0 && sigma <= 16))
      throw InputError(token.where, "the filter's sigma must be above 0 and at most 16");
    camera_.filterRadius = 4 * sigma;
  } else if (type == "mitchell") {
    camera_.filter = PixelFilter::mitchell;
    camera_.filterRadius = radius(2.f);
    in.ignore({"B", "C"});
  } else if (type == "sinc") {
    camera_.filter = PixelFilter::lanczos;
    camera_.filterRadius = std::max(1.f, std::round(radius(4.f)));
    in.ignore({"tau"});
  } else {
    findings_.warn(token.where, unknownName("filter", type,
                                            {"box", "triangle", "gaussian", "mitchell", "sinc"}) +
                                    "; the Gaussian is used");
    return;
  }
  in.finish("filter", findings_);
}

void Reader::sampler(const Token& token) {
  const std::string type = quoted(token, "type");
  Parameters in = parameters(token);
  const std::vector<std::string> known{"independent", "stratified", "halton", "sobol",
                                       "paddedsobol", "zsobol",     "pmj02bn"};
  if (!contains(known, type))
    findings_.warn(token.where, unknownName("sampler", type, known) + "; it is only a hint");
  const int count = type == "stratified" ? in.integer("xsamples", 4) * in.integer("ysamples", 4)
                                         : in.integer("pixelsamples", 16);
  if (count > 0) camera_.spp = count;
  in.ignore({"randomization", "seed", "jitter", "dimensions"});
  in.finish("sampler", findings_);
}

void Reader::integrator(const Token& token) {
  const std::string type = quoted(token, "type");
  Parameters in = parameters(token);
  const std::vector<std::string> known{"path",     "volpath",   "simplepath", "simplevolpath",
                                       "bdpt",     "mlt",       "sppm",       "ambientocclusion",
                                       "function", "lightpath", "randomwalk"};
  if (!contains(known, type))
    findings_.warn(token.where, unknownName("integrator", type, known) + "; it is only a hint");
  scene_.integrator = type;
  // PBRT counts scattering events, we count the emission too.
  const int depth = in.integer("maxdepth", 5);
  if (depth < 0) throw InputError(token.where, "maxdepth is below 0");
  scene_.maxDepth = std::min(depth, 1 << 20) + 1;
}

void Reader::accelerator(const Token& token) {
  quoted(token, "type");
  readParameters(*in_);  // of PBRT's program
}

void Reader::makeCamera() {
  if (cameraType_.empty()) {
    cameraType_ = "perspective";
    findings_.inform({mainFile_, 0, 0}, "no Camera: PBRT's default, at the origin along +z");
  }
  Parameters& in = cameraParameters_;
  Camera& c = camera_;
  if (!hasFilm_) c.width = 1280, c.height = 720;
  if (c.filterRadius == 0 && c.filter == PixelFilter::gaussian) c.filterRadius = 2;
  if (scene_.integrator.empty()) scene_.integrator = "volpath", scene_.maxDepth = 6;
  const double filmAspect = static_cast<double>(c.width) / c.height;
  const Window window = screenWindow(in, filmAspect);
  double halfWidth = 0.5 * window.width();
  if (cameraType_ == "perspective") {
    const double fov = in.number("fov").value_or(90);
    if (!(fov > 0 && fov < 180))
      throw InputError(in.where(), fmt::format("fov is {}; it lies between 0 and 180", fov));
    c.fovX = static_cast<float>(
        2 * std::atan(halfWidth * std::tan(0.5 * fov * static_cast<double>(kPi) / 180)));
    halfWidth = 1;
  } else {
    c.type = CameraType::orthographic;
  }
  c.principalPointOffset = {static_cast<float>(0.5 * (window.x0 + window.x1) / window.width()),
                            static_cast<float>(-0.5 * (window.y0 + window.y1) / window.height())};
  // Our pixels are square: other windows stretch y.
  const double stretch = filmAspect * window.height() / window.width();
  const bool isSquare = std::abs(stretch - 1) < 1e-4;
  if (!isSquare)
    findings_.warn(in.where(), fmt::format("the camera's pixels are not square ({:.4g}); light "
                                           "tracing does not allow for that",
                                           stretch));
  const double y = isSquare ? 1 : stretch;
  c.toWorld =
      placement(*inverse(cameraFromWorld_) * scaling({-halfWidth, halfWidth * y, 1}), in.where());
  c.nearClip = kNear, c.farClip = kFar;
  c.focusDistance = in.number("focaldistance", 1e6f);
  c.apertureRadius = c.type == CameraType::perspective ? in.number("lensradius", 0.f) : 0.f;
  if (c.apertureRadius < 0 || !(c.focusDistance > 0))
    throw InputError(in.where(), "lensradius must be 0 or more, focaldistance above 0");
  in.ignore({"shutteropen", "shutterclose"});
  if (c.type == CameraType::orthographic)
    in.unsupported("lensradius", "orthographic cameras see sharply", findings_);
  in.finish("camera", findings_);
  c.name = "camera";  // as PBRT calls its coordinate system
  scene_.cameras.push_back(c);
}

}  // namespace lobelia::io::pbrt
