// The window itself: GLFW's window with its OpenGL context, Dear ImGui's backends upon it and the
// picture's texture.
//
// All of it is made anew when the context is lost (a driver that was reset, a graphics card that
// was taken away); Dear ImGui's own state and what a person has done stay. Only the thread that
// made it may use it.
#pragma once

#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "lobelia/app/viewer/window/gl_functions.h"
#include "lobelia/app/viewer/window/picture_texture.h"
#include "lobelia/base/vec.h"

namespace lobelia::app {

class Surface {
 public:
  // A window of so many pixels, less where the screen is smaller. Throws RuntimeError without a
  // display or without OpenGL 3.0.
  Surface(Vec2i pixels, const std::string& title);
  ~Surface();
  Surface(const Surface&) = delete;
  Surface& operator=(const Surface&) = delete;

  GLFWwindow* window() const { return window_; }
  bool closing() const { return glfwWindowShouldClose(window_) != 0; }
  // Waits for input, wake() or so many seconds, then handles what there is.
  void wait(double seconds);
  static void wake();  // from any thread

  // Did mouse, keys or the window's size change since the last call?
  bool takeInput() { return std::exchange(input_, false); }

  // Of the framebuffer; 0 when minimised.
  Vec2i pixels() const;
  bool drawable() const;
  // Framebuffer pixels to a unit of Dear ImGui.
  float pixelScale() const;
  // To so many pixels; a side of 0 is pretended, since window systems have none.
  void resize(Vec2i pixels);
  int largestTexture() const { return largestTexture_; }

  // Tells Dear ImGui what there is of input; ImGui::NewFrame() follows.
  void beginFrame();
  // Draws the frame. False: the context is lost. drawn: filled with it when not null, 8-bit RGB,
  // the top row first.
  bool endFrame(std::vector<uint8_t>* drawn = nullptr);

  PictureTexture& texture() { return *texture_; }
  bool lost() const;
  void recreate();                               // throws as the constructor does
  void pretendLost() { pretendedLost_ = true; }  // for tests: as a driver would say it

  // Files that were dropped since the last call.
  std::vector<std::string> takeDropped() { return std::exchange(dropped_, {}); }

 private:
  void open(Vec2i pixels);
  void close();
  void listen();
  std::vector<uint8_t> read(Vec2i size) const;
  void styleText();

  std::string title_;
  GLFWwindow* window_ = nullptr;
  GlFunctions gl_{};
  std::unique_ptr<PictureTexture> texture_;
  int largestTexture_ = 0;
  float textScale_ = 0;
  bool pretendedLost_ = false, pretendedEmpty_ = false, input_ = true;
  std::vector<std::string> dropped_;
};

}  // namespace lobelia::app
