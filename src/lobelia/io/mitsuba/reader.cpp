// The top level of a Mitsuba scene.

#include "lobelia/io/mitsuba/reader.h"

#include <filesystem>

namespace lobelia::io {
namespace mitsuba {

ReadingGuard::ReadingGuard(std::set<const Element*>& open, const Element& element)
    : open_(open), element_(element) {
  // References can nest deeper than elements do; the stack is finite.
  constexpr size_t kMaxOpen = 64;
  if (open_.size() >= kMaxOpen) {
    throw InputError(element.where, "the " + element.tag + " '" + element.valueOr("id", "") +
                                        "' lies inside more than " + std::to_string(kMaxOpen) +
                                        " others; nest fewer");
  }
  if (!open_.insert(&element).second) {
    throw InputError(element.where, "the " + element.tag + " '" + element.valueOr("id", "") +
                                        "' refers to itself");
  }
}

Transform makeTransform(const Mat4& matrix, const Location& where) {
  if (!inverse(matrix))
    throw InputError(where,
                     "the transform here has no inverse; it flattens everything or leaves "
                     "the range of numbers");
  return Transform(matrix);
}

void Reader::read() {
  Object root = open(document_.scene);
  for (const Element* e : root.nested("integrator")) integrator(*e);
  // Objects that nothing refers to are read too: their mistakes are worth knowing.
  for (const Element* e : root.nested("texture")) texture(*e);
  for (const Element* e : root.nested("bsdf")) material(*e);
  const std::vector<const Element*> shapes = root.nested("shape");
  for (size_t i = 0; i < shapes.size() && !context_.cancelled(); ++i) {
    context_.progress("load", static_cast<double>(i) / static_cast<double>(shapes.size()));
    shape(*shapes[i]);
  }
  assumeTwoSided();
  for (const Element* e : root.nested("emitter")) emitter(*e);
  for (const Element* e : root.nested("sensor")) sensor(*e);
  if (scene_.cameras.empty()) defaultSensor();
  for (const Element* e : root.nested("medium")) {
    findings_.warn(e->where, "participating media are not supported; the medium is ignored");
  }
  // Without meaning outside of an object that uses them.
  for (const char* tag : {"film", "sampler", "rfilter", "phase", "volume", "spectrum"}) {
    for (const Element* e : root.nested(tag)) {
      if (!e->has("id")) {
        findings_.warn(e->where, "the <" + e->tag + "> belongs to no object and is ignored");
      }
    }
  }
  root.finish();
}

}  // namespace mitsuba

Scene readMitsuba(const std::string& file, const ReadSettings& settings, Context& context) {
  Scene scene;
  scene.file = file;
  scene.name = std::filesystem::path(file).stem().string();
  if (scene.name == "scene") {
    std::error_code error;
    const auto folder = std::filesystem::absolute(file, error).parent_path().filename();
    if (!folder.empty()) scene.name = folder.string();
  }
  std::vector<Finding> found;
  Findings findings(found, settings.strict);
  const mitsuba::Document document = mitsuba::loadDocument(file, settings.definitions, findings);
  mitsuba::Reader reader(document, scene, settings.time, findings, context);
  reader.read();
  applyEnvironment(scene, settings);
  scene.findings = std::move(found);
  return scene;
}

}  // namespace lobelia::io
