#include "lobelia/app/frames.h"

#include <fmt/format.h>

#include <charconv>
#include <filesystem>
#include <functional>
#include <stdexcept>
#include <utility>

#include "lobelia/app/frame_setup.h"
#include "lobelia/scene/camera_path.h"

namespace lobelia::app {
namespace {

// The first and the last of the frames to render.
std::pair<int, int> frameRange(const RenderOptions& options) {
  if (options.frame.empty()) return {0, options.frames - 1};
  int first = 0;
  const char* end = options.frame.data() + options.frame.size();
  auto [next, error] = std::from_chars(options.frame.data(), end, first);
  int last = first;
  if (error == std::errc() && next != end && *next == '-') {
    const auto second = std::from_chars(next + 1, end, last);
    next = second.ptr, error = second.ec;
  }
  if (error != std::errc() || next != end || first < 0 || last < first || last >= options.frames) {
    throw UsageError(fmt::format("--frame '{}' is neither a frame nor a range A-B from 0 to {}",
                                 options.frame, options.frames - 1));
  }
  return {first, last};
}

RenderOptions optionsOf(const RenderOptions& options, int number) {
  RenderOptions out = options;
  for (std::string& file : out.outputs) file = frameFile(file, number);
  for (std::string* file : {&out.stats, &out.checkpoint, &out.resume})
    if (!file->empty()) *file = frameFile(*file, number);
  return out;
}

double part(int number, int last) { return last > 0 ? static_cast<double>(number) / last : 0; }

std::function<Camera(int)> turntable(const Scene& scene, const Camera& camera, int frames) {
  const Vec3d pivot = turntablePivot(camera, bounds(scene)), axis = verticalAxis(camera);
  return
      [=](int number) { return turned(camera, pivot, axis, static_cast<double>(number) / frames); };
}

std::function<Camera(int)> alongKeys(const Camera& camera, int frames) {
  const double begin = static_cast<double>(camera.path.front().time),
               end = static_cast<double>(camera.path.back().time);
  return [=](int number) {
    const double u = part(number, frames - 1);
    return cameraAt(camera, begin + (end - begin) * u);
  };
}

// The camera of every frame.
std::function<Camera(int)> motion(const Scene& scene, const RenderOptions& options,
                                  bool mayStandStill) {
  const std::vector<Camera> cameras = chooseCameras(scene, options);
  if (options.turntable) {
    if (cameras.size() > 1)
      throw UsageError(
          fmt::format("--turntable starts at one camera, not at '{}'", options.camera));
    return turntable(scene, cameras.front(), options.frames);
  }
  if (cameras.size() == 1) {
    if (cameras.front().path.empty()) {
      if (mayStandStill) return [camera = cameras.front()](int) { return camera; };
      throw UsageError(
          fmt::format("--frames: the camera '{}' of this scene does not move; name several for a "
                      "path (--camera A,B,C) or turn about the scene (--turntable)",
                      cameras.front().name));
    }
    return alongKeys(cameras.front(), options.frames);
  }
  try {
    return [path = ViewPath(cameras), last = options.frames - 1](int number) {
      return path.at(part(number, last));
    };
  } catch (const std::invalid_argument& e) {
    throw UsageError(fmt::format("--camera {}: {}", options.camera, e.what()));
  }
}

}  // namespace

std::string frameFile(const std::string& file, int number) {
  for (size_t at = file.find('%'); at != std::string::npos; at = file.find('%', at + 1)) {
    const size_t end = file.find_first_not_of("0123456789", at + 1);
    if (end == std::string::npos || file[end] != 'd' || end - at > 3) continue;
    int width = 0;
    std::from_chars(file.data() + at + 1, file.data() + end, width);
    return fmt::format("{}{:0{}}{}", file.substr(0, at), number, width, file.substr(end + 1));
  }
  const std::filesystem::path path(file);
  const std::string extension = path.extension().string();
  return fmt::format("{}.{:04}{}", file.substr(0, file.size() - extension.size()), number,
                     extension);
}

void requireFrames(const RenderOptions& options) {
  if (options.frames == 0) {
    if (options.turntable) throw UsageError("--turntable: say in how many frames with --frames N");
    if (!options.frame.empty())
      throw UsageError("--frame: say of how many frames it is one with --frames N");
    return requireOutputs(options);
  }
  const auto [first, last] = frameRange(options);
  if (!options.replay.empty() && first != last)
    throw UsageError("--replay is of one picture; say which with --frame K");
  for (int number = first; number <= last; ++number) requireOutputs(optionsOf(options, number));
}

std::vector<Frame> planFrames(const Scene& scene, const RenderOptions& options,
                              bool mayStandStill) {
  if (options.frames == 0) return {{0, chooseCamera(scene, options), options}};
  const std::function<Camera(int)> cameraOf = motion(scene, options, mayStandStill);
  const auto [first, last] = frameRange(options);
  std::vector<Frame> frames;
  for (int number = first; number <= last; ++number) {
    frames.push_back({number, cameraOf(number), optionsOf(options, number)});
    frames.back().camera.path.clear();
  }
  return frames;
}

}  // namespace lobelia::app
