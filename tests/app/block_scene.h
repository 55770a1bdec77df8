// A scene of few vertices for tests of transfer by the command line.
#pragma once

namespace lobelia::test {

// A glossy block on a floor under an even sky.
inline constexpr const char* kBlockScene = R"(<scene version="3.0.0">
  <sensor type="perspective">
    <float name="fov" value="40"/>
    <transform name="to_world"><lookat origin="2, 3, 5" target="0, 0.4, 0" up="0, 1, 0"/></transform>
    <film type="hdrfilm"><integer name="width" value="32"/><integer name="height" value="24"/>
      <rfilter type="box"/></film>
  </sensor>
  <emitter type="constant"><rgb name="radiance" value="0.5, 0.7, 1"/></emitter>
  <shape type="rectangle">
    <transform name="to_world"><scale value="2"/><rotate x="1" angle="-90"/></transform>
    <bsdf type="diffuse"><rgb name="reflectance" value="0.6, 0.5, 0.4"/></bsdf>
  </shape>
  <shape type="cube">
    <transform name="to_world"><scale value="0.5"/><translate y="0.55"/></transform>
    <bsdf type="roughconductor" id="paint"><float name="alpha" value="0.3"/></bsdf>
  </shape>
</scene>)";

}  // namespace lobelia::test
