#include "lobelia/app/viewer/window/gl_functions.h"

#include <fmt/format.h>

#include "lobelia/base/error.h"

namespace lobelia::app {
namespace {

template <class Function>
void find(Function& function, const char* name) {
  function = reinterpret_cast<Function>(glfwGetProcAddress(name));
  if (!function)
    throw RuntimeError(
        fmt::format("OpenGL's driver has no {}; another driver, or --headless, "
                    "which draws without a window",
                    name));
}

}  // namespace

GlFunctions GlFunctions::load() {
  GlFunctions gl{};
  find(gl.genTextures, "glGenTextures");
  find(gl.deleteTextures, "glDeleteTextures");
  find(gl.bindTexture, "glBindTexture");
  find(gl.texParameteri, "glTexParameteri");
  find(gl.texImage2D, "glTexImage2D");
  find(gl.texSubImage2D, "glTexSubImage2D");
  find(gl.pixelStorei, "glPixelStorei");
  find(gl.readPixels, "glReadPixels");
  find(gl.readBuffer, "glReadBuffer");
  find(gl.getError, "glGetError");
  find(gl.getIntegerv, "glGetIntegerv");
  find(gl.getString, "glGetString");
  find(gl.viewport, "glViewport");
  find(gl.clearColor, "glClearColor");
  find(gl.clear, "glClear");
  // A function's address alone says nothing: GLX hands one out for every name.
  if (glfwExtensionSupported("GL_ARB_robustness") || glfwExtensionSupported("GL_KHR_robustness"))
    for (const char* name : {"glGetGraphicsResetStatus", "glGetGraphicsResetStatusARB"})
      if (!gl.getGraphicsResetStatus)
        gl.getGraphicsResetStatus =
            reinterpret_cast<PFNGLGETGRAPHICSRESETSTATUSPROC>(glfwGetProcAddress(name));
  return gl;
}

}  // namespace lobelia::app
