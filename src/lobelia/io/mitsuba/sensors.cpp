// Sensors of Mitsuba scenes (perspective, thinlens, orthographic), their films, and the hints: the
// integrator and the sampler, of which nothing prevents rendering.

#include "lobelia/io/mitsuba/reader.h"
#include "lobelia/scene/camera_path.h"

namespace lobelia::io::mitsuba {
namespace {

constexpr int kMaxFilmSide = 1 << 17;
constexpr int64_t kMaxFilmPixels = int64_t{1} << 28;

const std::vector<std::string>& sensorTypes() {
  static const std::vector<std::string> types{"perspective", "thinlens", "orthographic"};
  return types;
}

bool contains(const std::vector<std::string>& names, const std::string& name) {
  return std::find(names.begin(), names.end(), name) != names.end();
}

// Longest deviation from 1 of the scale of the matrix' axes.
double scaleError(const Mat4& m) {
  double error = 0;
  for (size_t j = 0; j < 3; ++j) {
    double sum = 0;
    for (size_t i = 0; i < 3; ++i) sum += m.m[i][j] * m.m[i][j];
    error = std::max(error, std::abs(std::sqrt(sum) - 1));
  }
  return error;
}

const Attribute* undefinedIn(const Element& element) {
  for (const Attribute& a : element.attributes) {
    if (!a.undefined.empty()) return &a;
  }
  for (const Element& child : element.children) {
    if (const Attribute* a = undefinedIn(child)) return a;
  }
  return nullptr;
}

}  // namespace

float fieldOfView(Object& object, double aspect) {
  const std::optional<double> fov = object.number("fov");
  const std::optional<std::string> focal = object.string("focal_length");
  std::string axis = object.string("fov_axis").value_or("x");
  double radians = 0;
  if (fov && focal) {
    throw InputError(object.where(), "both fov and focal_length are given; give one of them");
  }
  if (fov) {
    radians = *fov * (static_cast<double>(kPi) / 180);
  } else {
    // 35 mm film: 36 x 24 mm, the focal length fixes the diagonal.
    std::string text = focal.value_or("50mm");
    if (text.size() > 2 && text.ends_with("mm")) text.resize(text.size() - 2);
    const double millimetres = parseNumber(text, object.element());
    if (millimetres <= 0) throw InputError(object.where(), "the focal_length must be above 0");
    radians = 2 * std::atan(std::sqrt(36.0 * 36.0 + 24.0 * 24.0) / (2 * millimetres));
    axis = "diagonal";
  }
  if (!(radians > 0 && radians < static_cast<double>(kPi))) {
    throw InputError(object.where(), "the field of view must be between 0 and 180 degrees");
  }
  if (axis == "smaller") axis = aspect > 1 ? "y" : "x";
  if (axis == "larger") axis = aspect > 1 ? "x" : "y";
  const double half = std::tan(0.5 * radians);
  if (axis == "x") return static_cast<float>(radians);
  if (axis == "y") return static_cast<float>(2 * std::atan(half * aspect));
  if (axis == "diagonal") {
    return static_cast<float>(2 * std::atan(half / std::sqrt(1 + 1 / (aspect * aspect))));
  }
  throw InputError(object.where(),
                   "fov_axis is '" + axis + "'; it may be x, y, diagonal, smaller or larger");
}

void Reader::sensor(const Element& element) {
  Object object = open(element);
  const std::string& type = object.type();
  if (!contains(sensorTypes(), type)) unknownType(object, sensorTypes());
  Camera camera;
  camera.width = film_.width, camera.height = film_.height;
  camera.cropX0 = film_.cropX0, camera.cropY0 = film_.cropY0;
  camera.cropX1 = film_.cropX1, camera.cropY1 = film_.cropY1;
  camera.filter = film_.filter, camera.filterRadius = film_.filterRadius;
  camera.spp = film_.spp;
  camera.name = object.id();
  const std::vector<const Element*> films = object.nested("film");
  if (films.size() > 1) throw InputError(films[1]->where, "a sensor can have only one film");
  if (!films.empty()) film(*films[0], &camera);
  for (const Element* e : object.nested("sampler")) sampler(*e, &camera);

  const Element* moving = object.property("to_world");
  if (moving && moving->tag == "animation") {
    camera.path = cameraKeys(*moving);
    camera = cameraAt(camera, static_cast<double>(time_));
  } else if (const std::optional<Mat4> matrix = object.transform("to_world")) {
    camera.toWorld = makeTransform(*matrix, object.where());
  }
  if (type != "orthographic" && scaleError(camera.toWorld.to) > 1e-3) {
    findings_.warn(object.where(), "the to_world of a " + type + " sensor has a scale");
  }
  camera.nearClip = object.number("near_clip", 1e-2f);
  camera.farClip = object.number("far_clip", 1e4f);
  if (!(camera.nearClip > 0 && camera.nearClip < camera.farClip)) {
    throw InputError(object.where(), "the clip planes are impossible; 0 < near_clip < far_clip");
  }
  camera.focusDistance = object.number("focus_distance", camera.farClip);
  if (type == "orthographic") {
    camera.type = CameraType::orthographic;
  } else {
    camera.fovX = fieldOfView(object, static_cast<double>(camera.width) / camera.height);
    camera.principalPointOffset = {
        object.number("principal_point_offset_x", object.number("shift_x", 0.f)),
        object.number("principal_point_offset_y", object.number("shift_y", 0.f))};
  }
  if (type == "thinlens") {
    const std::optional<double> radius = object.number("aperture_radius");
    if (!radius || *radius < 0 || camera.focusDistance <= 0) {
      throw InputError(object.where(),
                       "the thinlens needs an aperture_radius of 0 or more and a "
                       "focus_distance above 0");
    }
    camera.apertureRadius = static_cast<float>(*radius);
  }
  for (const Element* medium : object.nested("medium")) {
    findings_.warn(medium->where, "participating media are not supported; the medium is ignored");
  }
  object.ignore({"shutter_open", "shutter_close", "id"});
  object.finish();
  scene_.cameras.push_back(std::move(camera));
}

// Mitsuba 0.6: <animation> of <transform time="seconds">.
std::vector<CameraKey> Reader::cameraKeys(const Element& animation) const {
  std::vector<CameraKey> keys;
  for (const Element& child : animation.children) {
    if (child.tag != "transform") {
      throw InputError(child.where,
                       "an <animation> holds <transform time=\"...\">, not <" + child.tag + ">");
    }
    const float time = static_cast<float>(parseNumber(child.value("time"), child));
    if (!keys.empty() && !(time > keys.back().time)) {
      throw InputError(child.where, "the times of an <animation> must rise from key to key");
    }
    keys.push_back({time, makeTransform(parseTransform(child), child.where)});
    if ((keys.back().toWorld.to.determinant3() < 0) !=
        (keys.front().toWorld.to.determinant3() < 0)) {
      throw InputError(child.where,
                       "this key is a mirror image of the first; no motion leads from one to the "
                       "other");
    }
  }
  if (keys.empty()) {
    throw InputError(animation.where,
                     "the <animation> has no keys; add <transform time=\"0\"> and others");
  }
  return keys;
}

void Reader::film(const Element& element, Camera* out) {
  Object object = open(element);
  const std::vector<std::string> types{"hdrfilm", "ldrfilm", "mfilm", "tiledhdrfilm", "specfilm"};
  if (const Attribute* type = element.find("type");
      !type || !type->undefined.empty() || !contains(types, type->value)) {
    findings_.warn(object.where(), "unknown film '" + (type ? type->value : std::string()) +
                                       "' is read as hdrfilm");
  }
  out->width = object.integer("width", 768);
  out->height = object.integer("height", 576);
  if (out->width < 1 || out->height < 1 || out->width > kMaxFilmSide ||
      out->height > kMaxFilmSide || int64_t{out->width} * out->height > kMaxFilmPixels) {
    throw InputError(object.where(), "the film's size " + std::to_string(out->width) + " x " +
                                         std::to_string(out->height) +
                                         " is impossible; at least 1 x 1, at most 2^28 pixels");
  }
  crop(object, out);
  const std::vector<const Element*> filters = object.nested("rfilter");
  if (!filters.empty()) reconstructionFilter(*filters.back(), out);
  // How the other renderer writes its file says nothing about the image.
  object.ignore({"filename", "file_format", "pixel_format", "component_format", "banner",
                 "attach_log", "compensate", "sample_border", "gamma", "exposure", "key", "burn",
                 "tonemap_method", "has_variance"});
  object.finish();
}

void Reader::crop(Object& object, Camera* out) {
  const int x = object.integer("crop_offset_x", 0), y = object.integer("crop_offset_y", 0);
  const bool given = object.has("crop_width") || object.has("crop_height") || x != 0 || y != 0;
  const int width = object.integer("crop_width", out->width);
  const int height = object.integer("crop_height", out->height);
  if (!given) return;
  if (x < 0 || y < 0 || width < 1 || height < 1 || width > out->width - x ||
      height > out->height - y) {
    throw InputError(object.where(), "the crop window is not inside of the film of " +
                                         std::to_string(out->width) + " x " +
                                         std::to_string(out->height) + " pixels");
  }
  out->cropX0 = x;
  out->cropY0 = y;
  out->cropX1 = x + width;
  out->cropY1 = y + height;
}

void Reader::reconstructionFilter(const Element& element, Camera* out) {
  Object object = open(element);
  if (isUndefinedHint(element)) return;
  const std::string type = element.valueOr("type", "");
  object.ignore({"rfilter"});
  if (type == "box") {
    out->filter = PixelFilter::box;
    out->filterRadius = object.number("radius", 0.f);
  } else if (type == "tent") {
    out->filter = PixelFilter::tent;
    out->filterRadius = object.number("radius", 0.f);
  } else if (type == "gaussian") {
    out->filter = PixelFilter::gaussian;
    // Mitsuba cuts the Gaussian at four standard deviations.
    if (const auto stddev = object.number("stddev")) {
      out->filterRadius = 4 * static_cast<float>(*stddev);
    }
  } else if (type == "mitchell") {
    out->filter = PixelFilter::mitchell;
    object.ignore({"A", "B", "b", "c"});
  } else if (type == "catmullrom") {
    out->filter = PixelFilter::catmullRom;
  } else if (type == "lanczos") {
    out->filter = PixelFilter::lanczos;
    out->filterRadius = static_cast<float>(object.integer("lobes", 0));
  } else {
    findings_.warn(
        object.where(),
        "unknown reconstruction filter '" + type + "' is read as gaussian" +
            suggestion(type, {"box", "tent", "gaussian", "mitchell", "catmullrom", "lanczos"}));
  }
  if (out->filterRadius < 0 || out->filterRadius > 64) {
    throw InputError(object.where(), "the filter's radius is impossible; 0 to 64 pixels");
  }
  object.finish();
}

bool Reader::isUndefinedHint(const Element& element) {
  const Attribute* undefined = undefinedIn(element);
  if (!undefined) return false;
  findings_.warn(element.where, "the parameter $" + undefined->undefined + " has no value; this " +
                                    element.tag + " is only a hint and is ignored");
  return true;
}

void Reader::sampler(const Element& element, Camera* out) {
  const Attribute* undefined = undefinedIn(element);
  if (undefined && isUndefinedHint(element)) return;
  Object object = open(element);
  const std::vector<std::string> types{"independent", "stratified", "ldsampler",   "halton",
                                       "hammersley",  "sobol",      "multijitter", "orthogonal"};
  const std::string type = element.valueOr("type", "");
  if (!contains(types, type)) {
    findings_.warn(element.where,
                   "unknown sampler '" + type + "' is ignored" + suggestion(type, types));
  }
  if (const std::optional<int> count = object.hint("sample_count")) {
    if (*count < 1) {
      findings_.warn(element.where, "the sample_count is not above 0 and is ignored");
    } else {
      out->spp = *count;
    }
  }
  object.ignore({"dimension", "scramble", "seed", "jitter", "wavefront_size"});
  object.finish();
}

// Nested integrators (moment, aov, multichannel...) are looked through.
void Reader::integrator(const Element& element) {
  const Attribute* type = element.find("type");
  const bool undefined = type && !type->undefined.empty();
  if (undefined) {
    findings_.warn(element.where, "the parameter $" + type->undefined +
                                      " has no value; the integrator is only a hint and its type "
                                      "is ignored");
  }
  Object object = open(element);
  const std::vector<std::string> types{"path",    "direct",       "volpath",     "volpathmis",
                                       "ptracer", "bdpt",         "pssmlt",      "mlt",
                                       "erpt",    "photonmapper", "ppm",         "sppm",
                                       "vpl",     "irrcache",     "adaptive",    "moment",
                                       "aov",     "depth",        "stokes",      "volpath_simple",
                                       "ao",      "field",        "multichannel"};
  if (type && !undefined) {
    if (!contains(types, type->value)) {
      findings_.warn(element.where, "unknown integrator '" + type->value +
                                        "' is only a hint and is ignored" +
                                        suggestion(type->value, types));
    }
    scene_.integrator = type->value;
  }
  const Element* depth = object.property("max_depth");
  if (depth && !undefinedIn(*depth)) {
    if (const std::optional<int> value = object.hint("max_depth")) {
      if (*value < -1) {
        findings_.warn(depth->where, "max_depth is below -1 and is ignored");
      } else {
        scene_.maxDepth = *value;
      }
    }
  } else if (depth) {
    isUndefinedHint(*depth);
  }
  if (const Element* hide = object.property("hide_emitters"); hide && !undefinedIn(*hide)) {
    scene_.hideEmitters = object.boolean("hide_emitters", false);
  }
  for (const Element* inner : object.nested("integrator")) integrator(*inner);
  object.ignore({"rr_depth", "strict_normals", "samples_per_pass", "timeout", "block_size"});
  // Only integrators whose properties are known are worth a warning for the others.
  if (scene_.integrator == "path" || scene_.integrator == "direct") {
    object.ignore({"emitter_samples", "bsdf_samples", "shading_samples", "aovs"});
    object.finish();
  }
}

// What Mitsuba 3 does without a sensor: looks along +z at the whole scene.
void Reader::defaultSensor() {
  const Location& where = document_.scene.where;
  findings_.warn(where, "the scene has no sensor; one that sees the whole scene is added");
  Camera camera;
  camera.fovX = kPi / 4;
  const Bounds3f box = bounds(scene_);
  if (!box.empty()) {
    const Vec3f centre = box.centre(), extent = box.extent();
    const float distance = maxComponent(extent) / (2 * std::tan(kPi / 8));
    camera.toWorld =
        makeTransform(translation({static_cast<double>(centre.x), static_cast<double>(centre.y),
                                   static_cast<double>(box.lo.z - distance)}),
                      where);
    camera.nearClip = std::max(distance / 100, 1e-6f);
    camera.farClip = 5 * maxComponent(extent) + distance + 1;
  }
  camera.focusDistance = camera.farClip;
  scene_.cameras.push_back(std::move(camera));
}

}  // namespace lobelia::io::mitsuba
