// A small scene with cameras that move and stand, for the whole program.
#pragma once

#include <string>

#include "support/run_program.h"

namespace lobelia::test {

// Cameras "moves" (keys from 2 s to 4 s), "a", "b", "c".
inline std::string writeMovingScene(const TemporaryFolder& folder) {
  const auto sensor = [](const std::string& id, const std::string& place) {
    return "<sensor type=\"perspective\" id=\"" + id + "\">" + place +
           "<float name=\"fov\" value=\"40\"/><film type=\"hdrfilm\">"
           "<integer name=\"width\" value=\"24\"/><integer name=\"height\" value=\"16\"/>"
           "<rfilter type=\"box\"/></film></sensor>\n";
  };
  const auto look = [](const std::string& from) {
    return "<lookat origin=\"" + from + "\" target=\"0,0,0\" up=\"0,1,0\"/>";
  };
  const auto stand = [&](const std::string& from) {
    return "<transform name=\"to_world\">" + look(from) + "</transform>";
  };
  const std::string file = folder / "moving.xml";
  writeText(file,
            "<scene version=\"3.0.0\"><integrator type=\"path\">"
            "<integer name=\"max_depth\" value=\"3\"/></integrator>\n" +
                sensor("moves", "<animation name=\"to_world\"><transform time=\"2\">" +
                                    look("0,1,6") + "</transform><transform time=\"4\">" +
                                    look("3,1,5") + "</transform></animation>") +
                sensor("a", stand("0,1,6")) + sensor("b", stand("6,1,0")) +
                sensor("c", stand("0,3,-6")) +
                R"(<emitter type="point"><point name="position" x="2" y="4" z="3"/>
  <rgb name="intensity" value="20,20,20"/></emitter>
<shape type="sphere"><bsdf type="diffuse"><rgb name="reflectance" value="0.8,0.2,0.1"/></bsdf></shape>
<shape type="rectangle"><transform name="to_world"><scale value="4"/><rotate x="1" angle="-90"/>
  <translate y="-1"/></transform></shape>
</scene>)");
  return file;
}

}  // namespace lobelia::test
