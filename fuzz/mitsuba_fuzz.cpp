// Mitsuba XML scenes; what has no shapes is a design as well.
#include "fuzz/fuzz_file.h"
#include "lobelia/io/design.h"
#include "lobelia/io/scene_io.h"

using namespace lobelia;

extern "C" int LLVMFuzzerTestOneInput(const uint8_t* data, size_t size) {
  static const fuzz::FuzzFile file("scene.xml");
  return fuzz::checkScene(file, data, size, [](const std::string& path, Context& context) {
    Scene scene = io::readMitsuba(path, {}, context);
    try {
      Scene changed = scene;
      io::applyDesign(path, {}, changed, context);
      return changed;
    } catch (const InputError&) {
      return scene;
    }
  });
}
