// Captured reflectance in Mitsuba's format: our own bsdf `sphericalgaussians` (reflectance,
// int_ior, amplitude0, sharpness0, amplitude1, ...), and tables of MERL (`merl`, or `measured`,
// whose tensor files of Mitsuba 3 are not read), fitted when they are loaded.
#include <fmt/format.h>

#include <sstream>

#include "lobelia/io/file_bytes.h"
#include "lobelia/io/merl_reader.h"
#include "lobelia/io/mitsuba/reader.h"
#include "lobelia/io/mitsuba/writer.h"

namespace lobelia::io::mitsuba {

Material Reader::sphericalGaussians(Object& object) {
  Material m;
  m.type = MaterialType::sphericalGaussians;
  m.diffuse = color(object, "reflectance", Rgb(0.f));
  m.ior = namedOrNumber(object, "int_ior", "vacuum") / namedOrNumber(object, "ext_ior", "vacuum");
  if (m.ior < 1) {
    throw InputError(
        object.where(),
        fmt::format("the sphericalgaussians' index of refraction is {:.4g}; it must be "
                    "1 (no Fresnel term) or more",
                    m.ior));
  }
  for (int i = 0; object.has(fmt::format("amplitude{}", i)); ++i) {
    const std::string sharpness = fmt::format("sharpness{}", i);
    if (!object.has(sharpness)) {
      throw InputError(object.where(),
                       fmt::format("amplitude{} has no {} beside it", i, sharpness));
    }
    m.capturedLobes.push_back(
        {color(object, fmt::format("amplitude{}", i), Rgb(0.f), SpectrumUse::unbounded),
         scalar(object, sharpness, 1)});
  }
  return m;
}

Material Reader::measured(Object& object) {
  const std::optional<std::string> file = object.string("filename");
  if (!file) throw InputError(object.where(), "the " + object.type() + " has no filename");
  const int lobes = object.integer("lobes", 3);
  if (lobes < 1 || lobes > kMaxFittedLobes) {
    throw InputError(object.where(), fmt::format("{} lobes are asked for; there may be 1 to {}",
                                                 lobes, kMaxFittedLobes));
  }
  if (file->ends_with(".bsdf")) {
    throw InputError(object.where(),
                     "tensor files (.bsdf) are not supported; tables of MERL (.binary) are");
  }
  const TabulatedBrdf table = readMerl(document_.resolve(*file, object.where()), object.where());
  const CapturedFit fit = fitCaptured(table, lobes);
  findings_.inform(object.where(), *file + ": " + describeFit(table, fit));
  if (const std::string doubts = doubtsAbout(table, fit); !doubts.empty())
    findings_.warn(object.where(), *file + ": " + doubts);
  return materialOf(fit);
}

void Writer::sphericalGaussians(Node node, const Material& m) {
  color(node, "reflectance", m.diffuse);
  property(node, "float", "int_ior", text(m.ior));
  for (size_t i = 0; i < m.capturedLobes.size(); ++i) {
    color(node, fmt::format("amplitude{}", i).c_str(), m.capturedLobes[i].amplitude);
    scalar(node, fmt::format("sharpness{}", i).c_str(), m.capturedLobes[i].sharpness);
  }
}

}  // namespace lobelia::io::mitsuba

namespace lobelia::io {

void writeFit(const std::string& file, const CapturedFit& fit, const std::string& id) {
  pugi::xml_document document;
  pugi::xml_node scene = document.append_child("scene");
  scene.append_attribute("version") = "3.0.0";
  pugi::xml_node bsdf = mitsuba::object(scene, "bsdf", "sphericalgaussians", id);
  mitsuba::property(bsdf, "rgb", "reflectance", mitsuba::text(fit.diffuse));
  mitsuba::property(bsdf, "float", "int_ior", mitsuba::text(fit.ior));
  for (size_t i = 0; i < fit.lobes.size(); ++i) {
    mitsuba::property(bsdf, "rgb", fmt::format("amplitude{}", i).c_str(),
                      mitsuba::text(fit.lobes[i].amplitude));
    mitsuba::property(bsdf, "float", fmt::format("sharpness{}", i).c_str(),
                      mitsuba::text(fit.lobes[i].sharpness));
  }
  std::ostringstream out;
  document.save(out, "  ");
  writeFileAtomically(file, out.str());
}

}  // namespace lobelia::io
