// The top level: files, includes and the table of directives.
#include "lobelia/io/pbrt/reader.h"

#include <fmt/format.h>

#include <filesystem>

#include "lobelia/io/file_bytes.h"
#include "lobelia/io/gzip.h"

namespace lobelia::io {
namespace pbrt {
namespace {

constexpr size_t kMaxOpenFiles = 64;

}  // namespace

const std::vector<Reader::Directive>& Reader::directives() {
  constexpr auto anywhere = Directive::anywhere, options = Directive::options,
                 world = Directive::world;
  static const std::vector<Directive> table{
      {"Accelerator", options, &Reader::accelerator},
      {"ActiveTransform", anywhere, &Reader::activeTransform},
      {"AreaLightSource", world, &Reader::areaLightSource},
      {"Attribute", anywhere, &Reader::attribute},
      {"AttributeBegin", world, &Reader::attributeBegin},
      {"AttributeEnd", world, &Reader::attributeEnd},
      {"Camera", options, &Reader::camera},
      {"ColorSpace", anywhere, &Reader::colorSpace},
      {"ConcatTransform", anywhere, &Reader::concatTransform},
      {"CoordSysTransform", anywhere, &Reader::coordSysTransform},
      {"CoordinateSystem", anywhere, &Reader::coordinateSystem},
      {"Film", options, &Reader::film},
      {"Identity", anywhere, &Reader::identity},
      {"Import", world, &Reader::import},
      {"Include", anywhere, &Reader::include},
      {"Integrator", options, &Reader::integrator},
      {"LightSource", world, &Reader::lightSource},
      {"LookAt", anywhere, &Reader::lookAt},
      {"MakeNamedMaterial", world, &Reader::makeNamedMaterial},
      {"MakeNamedMedium", anywhere, &Reader::makeNamedMedium},
      {"Material", world, &Reader::material},
      {"MediumInterface", anywhere, &Reader::mediumInterface},
      {"NamedMaterial", world, &Reader::namedMaterial},
      {"ObjectBegin", world, &Reader::objectBegin},
      {"ObjectEnd", world, &Reader::objectEnd},
      {"ObjectInstance", world, &Reader::objectInstance},
      {"Option", anywhere, &Reader::option},
      {"PixelFilter", options, &Reader::pixelFilter},
      {"ReverseOrientation", anywhere, &Reader::reverseOrientation},
      {"Rotate", anywhere, &Reader::rotate},
      {"Sampler", options, &Reader::sampler},
      {"Scale", anywhere, &Reader::scale},
      {"Shape", world, &Reader::shape},
      {"Texture", world, &Reader::texture},
      {"Transform", anywhere, &Reader::transform},
      {"TransformBegin", anywhere, &Reader::transformBegin},
      {"TransformEnd", anywhere, &Reader::transformEnd},
      {"TransformTimes", anywhere, &Reader::transformTimes},
      {"Translate", anywhere, &Reader::translate},
      {"WorldBegin", options, &Reader::worldBegin},
  };
  return table;
}

Reader::Reader(Scene& scene, Findings& findings, Context& context, const std::string& file)
    : scene_(scene),
      findings_(findings),
      context_(context),
      mainFile_(file),
      folder_(std::filesystem::path(file).parent_path().string()) {}

void Reader::read() {
  runFile(mainFile_, {mainFile_, 0, 0});
  if (!saved_.empty()) {
    const Saved& open = saved_.back();
    throw InputError(open.where,
                     fmt::format("the {}Begin here has no {}End", open.kind, open.kind));
  }
  if (!inWorld_) {
    throw InputError({mainFile_, 0, 0},
                     "the file has no WorldBegin; the shapes of a scene stand behind it");
  }
  loadMeshes();
  finishAreaLights();
  applySensor();
}

void Reader::runFile(const std::string& file, const Location& from) {
  std::error_code error;
  const std::string key = std::filesystem::weakly_canonical(file, error).string();
  if (std::find(openFiles_.begin(), openFiles_.end(), key) != openFiles_.end())
    throw InputError(from, fmt::format("'{}' includes itself", file));
  if (openFiles_.size() >= kMaxOpenFiles)
    throw InputError(from, fmt::format("more than {} files include one another", kMaxOpenFiles));
  std::string bytes = readFileBytes(file, "scene", from);
  if (isGzip(bytes)) bytes = gunzip(bytes, {file, 0, 0});
  Tokenizer tokenizer(std::move(bytes), file);
  Tokenizer* const outer = in_;
  in_ = &tokenizer;
  openFiles_.push_back(key);
  while (!context_.cancelled()) {
    const std::optional<Token> token = tokenizer.next();
    if (!token) break;
    runDirective(*token);
  }
  openFiles_.pop_back();
  in_ = outer;
}

void Reader::runDirective(const Token& token) {
  if (token.type != TokenType::word) {
    throw InputError(token.where, fmt::format("a directive was expected, not {}",
                                              token.type == TokenType::string
                                                  ? fmt::format("the string \"{}\"", token.text)
                                                  : fmt::format("'{}'", token.text)));
  }
  for (const Directive& directive : directives()) {
    if (token.text != directive.name) continue;
    if (directive.block == Directive::world && !inWorld_)
      throw InputError(token.where, fmt::format("{} belongs behind WorldBegin", token.text));
    if (directive.block == Directive::options && inWorld_)
      throw InputError(token.where, fmt::format("{} belongs in front of WorldBegin", token.text));
    return (this->*directive.run)(token);
  }
  if (token.text == "WorldEnd") {
    return findings_.warn(token.where,
                          "WorldEnd is of PBRT-v3 and means nothing; this is read as "
                          "a file of PBRT-v4");
  }
  std::vector<std::string> known;
  for (const Directive& directive : directives()) known.emplace_back(directive.name);
  throw InputError(token.where, unknownName("directive", token.text.substr(0, 60), known));
}

void Reader::include(const Token& token) {
  runFile(resolve(quoted(token, "file"), "scene", token.where), token.where);
}

// Its graphics state is its own.
void Reader::import(const Token& token) {
  const State outer = state_;
  const size_t depth = saved_.size();
  runFile(resolve(quoted(token, "file"), "scene", token.where), token.where);
  if (saved_.size() != depth)
    throw InputError(token.where, "the imported file's Begin and End directives do not match");
  state_ = outer;
}

void Reader::worldBegin(const Token&) {
  makeCamera();
  inWorld_ = true;
  state_.ctm = Mat4();
  state_.atStart = state_.atEnd = true;
  coordinateSystems_["world"] = Mat4();
}

// By the main file, as PBRT does; else by the file that names it.
std::string Reader::resolve(const std::string& file, const std::string& what,
                            const Location& from) const {
  namespace fs = std::filesystem;
  if (file.empty()) throw InputError(from, fmt::format("the name of a {} file is empty", what));
  if (fs::path(file).is_absolute()) return file;
  const fs::path main = fs::path(folder_) / file;
  const fs::path near = fs::path(from.file).parent_path() / file;
  std::error_code error;
  if (fs::exists(main, error)) return main.string();
  if (fs::exists(near, error)) return near.string();
  throw InputError(from, fmt::format("there is no {} file '{}'; paths are relative to the scene's "
                                     "folder '{}'",
                                     what, file, folder_.empty() ? "." : folder_));
}

std::string Reader::quoted(const Token& directive, const char* what) {
  const std::optional<Token> token = in_->next();
  if (!token || token->type != TokenType::string) {
    throw InputError(directive.where,
                     fmt::format("{} needs a {} in quotes behind it", directive.text, what));
  }
  return token->text;
}

Parameters Reader::parameters(const Token& directive, const std::string& kind) {
  static const std::vector<Parameter> none;
  const auto defaults = state_.defaults.find(kind);
  return {readParameters(*in_), defaults == state_.defaults.end() ? none : defaults->second,
          directive.where};
}

void Reader::warnOnce(const Location& where, const std::string& message) {
  if (warned_.insert(message).second) findings_.warn(where, message);
}

}  // namespace pbrt

Scene readPbrt(const std::string& file, const ReadSettings& settings, Context& context) {
  Scene scene;
  scene.file = file;
  std::filesystem::path stem = std::filesystem::path(file).stem();
  if (stem.extension() == ".pbrt") stem = stem.stem();  // .pbrt.gz
  scene.name = stem.string();
  if (scene.name.starts_with("scene")) {
    std::error_code error;
    const auto folder = std::filesystem::absolute(file, error).parent_path().filename();
    if (!folder.empty()) scene.name = folder.string();
  }
  std::vector<Finding> found;
  Findings findings(found, settings.strict);
  for (const auto& [name, value] : settings.definitions)
    findings.warn({file, 0, 0},
                  fmt::format("-D {} means nothing: PBRT files have no parameters", name));
  pbrt::Reader(scene, findings, context, file).read();
  applyEnvironment(scene, settings);
  scene.findings = std::move(found);
  return scene;
}

}  // namespace lobelia::io
