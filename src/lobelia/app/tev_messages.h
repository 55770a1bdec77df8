// Messages of the viewer tev's network protocol (its manual, "Over the Network"; operations as of
// tev 1.17): [uint32 bytes in all][byte operation][payload], integers little-endian, strings ended
// by a zero byte.
#pragma once

#include <cstddef>
#include <span>
#include <string>
#include <vector>

#include "lobelia/base/vec.h"

namespace lobelia::app {

// Operation 4: a black image of channels R, G, B that takes the place of one of that name; tev
// shows it. [byte focus][name][int32 width, height, channels][channel names].
std::vector<std::byte> tevCreateImage(const std::string& name, int width, int height);
// Operation 6: new values for a window. [byte focus][name][int32 channels][channel names]
// [int32 x, y, width, height][int64 offset of every channel][int64 stride of every channel]
// [floats]; offsets and strides count floats. rows: width * height values, row by row.
std::vector<std::byte> tevUpdateImage(const std::string& name, int x, int y, int width, int height,
                                      std::span<const Rgb> values);

}  // namespace lobelia::app
