#include "lobelia/app/viewer/window/surface.h"

#include <backends/imgui_impl_glfw.h>
#include <backends/imgui_impl_opengl3.h>
#include <fmt/format.h>
#include <imgui.h>

#include <algorithm>
#include <cstring>

#include "lobelia/app/viewer/window/style.h"
#include "lobelia/base/error.h"

namespace lobelia::app {
namespace {

constexpr const char* kGlsl = "#version 130";  // of OpenGL 3.0

std::string& lastProblem() {
  static std::string text;  // GLFW's callback reaches nothing else
  return text;
}
void noteProblem(int, const char* text) { lastProblem() = text; }

[[noreturn]] void refuse(const std::string& what) {
  throw RuntimeError(fmt::format("{}{}{}; `lobelia view --headless` draws without a window", what,
                                 lastProblem().empty() ? "" : ": ", lastProblem()));
}

// No larger than the screen: servers refuse, or fail at, windows that they cannot hold.
Vec2i onScreen(Vec2i wanted) {
  GLFWmonitor* monitor = glfwGetPrimaryMonitor();
  if (!monitor) return wanted;
  int x = 0, y = 0, width = 0, height = 0;
  glfwGetMonitorWorkarea(monitor, &x, &y, &width, &height);
  if (width <= 0 || height <= 0) return wanted;
  return {std::min(wanted.x, width), std::min(wanted.y, height)};
}

}  // namespace

Surface::Surface(Vec2i pixels, const std::string& title) : title_(title) {
  glfwSetErrorCallback(noteProblem);
  if (!glfwInit()) refuse("no window can be opened");
  try {
    open(pixels);
  } catch (...) {
    close();
    glfwTerminate();
    throw;
  }
}

Surface::~Surface() {
  close();
  glfwTerminate();
}

void Surface::open(Vec2i pixels) {
  glfwDefaultWindowHints();
  glfwWindowHint(GLFW_CONTEXT_VERSION_MAJOR, 3);
  glfwWindowHint(GLFW_CONTEXT_VERSION_MINOR, 0);
  // Where the driver knows of it, a lost context says so.
  glfwWindowHint(GLFW_CONTEXT_ROBUSTNESS, GLFW_LOSE_CONTEXT_ON_RESET);
  glfwWindowHint(GLFW_DEPTH_BITS, 0);
  glfwWindowHint(GLFW_STENCIL_BITS, 0);
  glfwWindowHint(GLFW_SCALE_TO_MONITOR, GLFW_FALSE);  // sizes are in pixels
  const Vec2i size = onScreen(pixels);
  window_ = glfwCreateWindow(size.x, size.y, title_.c_str(), nullptr, nullptr);
  if (!window_) refuse("no window with OpenGL 3.0 can be opened");
  glfwMakeContextCurrent(window_);
  gl_ = GlFunctions::load();
  gl_.getIntegerv(GL_MAX_TEXTURE_SIZE, &largestTexture_);
  glfwSwapInterval(1);
  listen();
  if (!ImGui_ImplGlfw_InitForOpenGL(window_, true) || !ImGui_ImplOpenGL3_Init(kGlsl))
    refuse("the panels cannot be drawn by this OpenGL");
  texture_ = std::make_unique<PictureTexture>(gl_);
  styleText();
}

// Dear ImGui's callbacks, which come after, call these.
void Surface::listen() {
  glfwSetWindowUserPointer(window_, this);
  static constexpr auto of = [](GLFWwindow* window) {
    return static_cast<Surface*>(glfwGetWindowUserPointer(window));
  };
  glfwSetDropCallback(window_, [](GLFWwindow* w, int count, const char** files) {
    of(w)->dropped_.insert(of(w)->dropped_.end(), files, files + count);
    of(w)->input_ = true;
  });
  glfwSetCursorPosCallback(window_, [](GLFWwindow* w, double, double) { of(w)->input_ = true; });
  glfwSetCursorEnterCallback(window_, [](GLFWwindow* w, int) { of(w)->input_ = true; });
  glfwSetMouseButtonCallback(window_, [](GLFWwindow* w, int, int, int) { of(w)->input_ = true; });
  glfwSetScrollCallback(window_, [](GLFWwindow* w, double, double) { of(w)->input_ = true; });
  glfwSetKeyCallback(window_, [](GLFWwindow* w, int, int, int, int) { of(w)->input_ = true; });
  glfwSetCharCallback(window_, [](GLFWwindow* w, unsigned) { of(w)->input_ = true; });
  glfwSetWindowFocusCallback(window_, [](GLFWwindow* w, int) { of(w)->input_ = true; });
  glfwSetWindowRefreshCallback(window_, [](GLFWwindow* w) { of(w)->input_ = true; });
  glfwSetFramebufferSizeCallback(window_, [](GLFWwindow* w, int, int) { of(w)->input_ = true; });
}

void Surface::close() {
  if (!window_) return;
  texture_.reset();
  if (ImGui::GetIO().BackendRendererUserData) ImGui_ImplOpenGL3_Shutdown();
  if (ImGui::GetIO().BackendPlatformUserData) ImGui_ImplGlfw_Shutdown();
  glfwDestroyWindow(window_);
  window_ = nullptr;
}

// Text as large as the screen's resolution asks for.
void Surface::styleText() {
  float x = 1, y = 1;
  glfwGetWindowContentScale(window_, &x, &y);
  const float scale = std::clamp(std::max(x, y) / pixelScale(), 0.5f, 4.f);
  if (scale == textScale_) return;
  textScale_ = scale;
  applyStyle(scale, pixelScale());
  ImGui_ImplOpenGL3_DestroyFontsTexture();  // made anew with the next frame
  ImGui_ImplOpenGL3_DestroyDeviceObjects();
}

void Surface::wait(double seconds) {
  if (seconds > 0) {
    glfwWaitEventsTimeout(seconds);
  } else {
    glfwPollEvents();
  }
}

void Surface::wake() { glfwPostEmptyEvent(); }

Vec2i Surface::pixels() const {
  Vec2i size;
  if (!pretendedEmpty_) glfwGetFramebufferSize(window_, &size.x, &size.y);
  return size;
}

bool Surface::drawable() const {
  const Vec2i size = pixels();
  return size.x > 0 && size.y > 0 && !glfwGetWindowAttrib(window_, GLFW_ICONIFIED);
}

void Surface::resize(Vec2i wanted) {
  pretendedEmpty_ = wanted.x <= 0 || wanted.y <= 0;
  const float scale = pixelScale();
  const auto units = [&](int length) {
    return std::max(static_cast<int>(static_cast<float>(length) / scale), 1);
  };
  if (!pretendedEmpty_) glfwSetWindowSize(window_, units(wanted.x), units(wanted.y));
  input_ = true;
}

float Surface::pixelScale() const {
  int width = 0, height = 0;
  glfwGetWindowSize(window_, &width, &height);
  const Vec2i size = pixels();
  return width > 0 && size.x > 0 ? static_cast<float>(size.x) / static_cast<float>(width) : 1.f;
}

void Surface::beginFrame() {
  styleText();
  ImGui_ImplOpenGL3_NewFrame();
  ImGui_ImplGlfw_NewFrame();
}

bool Surface::endFrame(std::vector<uint8_t>* drawn) {
  ImGui::Render();
  const Vec2i size = pixels();
  gl_.viewport(0, 0, size.x, size.y);
  gl_.clearColor(0.07f, 0.07f, 0.08f, 1);
  gl_.clear(GL_COLOR_BUFFER_BIT);
  ImGui_ImplOpenGL3_RenderDrawData(ImGui::GetDrawData());
  if (drawn) *drawn = read(size);  // before buffers are exchanged: what is shown cannot be read
  glfwSwapBuffers(window_);
  return !lost();
}

std::vector<uint8_t> Surface::read(Vec2i size) const {
  const size_t row = static_cast<size_t>(size.x) * 3;
  std::vector<uint8_t> bottomUp(row * static_cast<size_t>(size.y)), out(bottomUp.size());
  gl_.pixelStorei(GL_PACK_ALIGNMENT, 1);
  gl_.readBuffer(GL_BACK);
  gl_.readPixels(0, 0, size.x, size.y, GL_RGB, GL_UNSIGNED_BYTE, bottomUp.data());
  for (size_t y = 0; y < static_cast<size_t>(size.y); ++y)
    std::memcpy(&out[y * row], &bottomUp[(static_cast<size_t>(size.y) - 1 - y) * row], row);
  return out;
}

bool Surface::lost() const {
  return pretendedLost_ ||
         (gl_.getGraphicsResetStatus && gl_.getGraphicsResetStatus() != GL_NO_ERROR);
}

void Surface::recreate() {
  Vec2i size = pixels();
  if (size.x <= 0 || size.y <= 0) size = {640, 480};
  int x = 0, y = 0;
  glfwGetWindowPos(window_, &x, &y);
  close();
  pretendedLost_ = false;
  textScale_ = 0;
  open(size);
  glfwSetWindowPos(window_, x, y);
}

}  // namespace lobelia::app
