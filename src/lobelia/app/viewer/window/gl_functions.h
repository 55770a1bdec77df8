// The few functions of OpenGL that the window calls itself, looked up when a context is there, so
// that the program links to no OpenGL and starts without any. (Dear ImGui's backend looks up its
// own.)
#pragma once

#define GLFW_INCLUDE_GLEXT
#include <GLFW/glfw3.h>

namespace lobelia::app {

struct GlFunctions {
  decltype(&glGenTextures) genTextures;
  decltype(&glDeleteTextures) deleteTextures;
  decltype(&glBindTexture) bindTexture;
  decltype(&glTexParameteri) texParameteri;
  decltype(&glTexImage2D) texImage2D;
  decltype(&glTexSubImage2D) texSubImage2D;
  decltype(&glPixelStorei) pixelStorei;
  decltype(&glReadPixels) readPixels;
  decltype(&glReadBuffer) readBuffer;
  decltype(&glGetError) getError;
  decltype(&glGetIntegerv) getIntegerv;
  decltype(&glGetString) getString;
  decltype(&glViewport) viewport;
  decltype(&glClearColor) clearColor;
  decltype(&glClear) clear;
  PFNGLGETGRAPHICSRESETSTATUSPROC getGraphicsResetStatus;  // null where the driver has none

  // Of the current context. Throws RuntimeError when one is missing.
  static GlFunctions load();
};

}  // namespace lobelia::app
