// Helpers of the tests of the Mitsuba reader: scenes given as text.
#pragma once

#include "io/temporary_folder.h"
#include "lobelia/io/scene_io.h"

namespace lobelia::test {

inline Scene readText(const TemporaryFolder& folder, const std::string& text,
                      const io::ReadSettings& settings = {}) {
  Context context;
  return io::readMitsuba(folder.write("scene.xml", text), settings, context);
}

// A scene of the current dialect, or of 0.6, around `body`. The sensor keeps findings empty.
inline std::string modern(const std::string& body) {
  return "<scene version=\"3.0.0\"><sensor type=\"perspective\"/>\n" + body + "\n</scene>";
}
inline std::string legacy(const std::string& body) {
  return "<scene version=\"0.6.0\"><sensor type=\"perspective\"/>\n" + body + "\n</scene>";
}

inline Scene readModern(const std::string& body, const io::ReadSettings& settings = {}) {
  const TemporaryFolder folder;
  return readText(folder, modern(body), settings);
}
inline Scene readLegacy(const std::string& body) {
  const TemporaryFolder folder;
  return readText(folder, legacy(body));
}

// What the reader says about a scene that it refuses.
inline std::string refusal(const std::string& body) {
  return messageOf<InputError>([&] { readModern(body); });
}

// The one finding of a scene, with its line.
inline std::string onlyFinding(const Scene& scene) {
  if (scene.findings.size() != 1) {
    ADD_FAILURE() << scene.findings.size() << " findings instead of one";
    for (const Finding& f : scene.findings) ADD_FAILURE() << f.message;
    return {};
  }
  return std::to_string(scene.findings[0].where.line) + ": " + scene.findings[0].message;
}

}  // namespace lobelia::test
