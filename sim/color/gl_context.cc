#include "sim/color/gl_context.h"

#include <dlfcn.h>

#include <array>
#include <cstdint>
#include <cstdlib>
#include <memory>
#include <mutex>

#include "robot/base/error.h"

namespace merlin::sim {
namespace {

// Constants from the EGL 1.5 registry and OSMesa's header.
constexpr unsigned kEglPlatformSurfaceless = 0x31DD, kEglOpenGlApi = 0x30A2;
constexpr std::int32_t kEglSurfaceType = 0x3033, kEglRenderableType = 0x3040, kEglOpenGlBit = 0x0008, kEglNone = 0x3038;
constexpr unsigned kOsmesaRgba = 0x1908, kOsmesaUnsignedByte = 0x1401, kGlRenderer = 0x1F01;

using EglHandle = void*;
using GetString = const unsigned char* (*)(unsigned);

// Mesa's software rasteriser reads these variables when its library is opened. The vector width affects the last bits
// of a picture, and a width of 512 bits has crashed. The number of threads does not affect the picture; 0 (draw in the
// calling thread) leaves the other cores to physics and rays. The user's own values are overwritten, so that all
// environments draw the same picture.
void PinRasteriser() {
  setenv("LP_NATIVE_VECTOR_WIDTH", "256", 1);
  setenv("LP_NUM_THREADS", "0", 1);
}

// A shared library that is never closed, because MuJoCo keeps pointers into it. Its symbols are global, because MuJoCo
// looks up GL functions among the global symbols.
class Library {
 public:
  explicit Library(const char* file) : file_(file), handle_(dlopen(file, RTLD_NOW | RTLD_GLOBAL)) {
    if (!handle_) throw MachineError(dlerror());
  }
  template <class Function>
  Function Get(const char* name) const {
    void* symbol = dlsym(handle_, name);
    if (!symbol) throw MachineError(std::string(file_) + " has no " + name);
    return reinterpret_cast<Function>(symbol);
  }

 private:
  const char* file_;
  void* handle_;
};

void Require(bool ok, const char* what) {
  if (!ok) throw MachineError(std::string(what) + " failed");
}

std::string RendererName(GetString get_string) {
  const unsigned char* text = get_string ? get_string(kGlRenderer) : nullptr;
  return text ? reinterpret_cast<const char*>(text) : "unknown renderer";
}

// MuJoCo binds its GL functions once per process. Claims the process for this back end; false if the other one has it.
bool Claim(Gl gl) {
  static std::mutex mutex;
  static Gl claimed = Gl::kOff;
  const std::lock_guard lock(mutex);
  if (claimed == Gl::kOff) claimed = gl;
  return claimed == gl;
}

}  // namespace

void GlContext::OpenEgl() {
  const Library egl("libEGL.so.1");
  const auto get_proc = egl.Get<void* (*)(const char*)>("eglGetProcAddress");
  const auto get_display =
      reinterpret_cast<EglHandle (*)(unsigned, void*, const std::int32_t*)>(get_proc("eglGetPlatformDisplayEXT"));
  const auto initialize = egl.Get<unsigned (*)(EglHandle, std::int32_t*, std::int32_t*)>("eglInitialize");
  const auto bind_api = egl.Get<unsigned (*)(unsigned)>("eglBindAPI");
  const auto choose =
      egl.Get<unsigned (*)(EglHandle, const std::int32_t*, EglHandle*, std::int32_t, std::int32_t*)>("eglChooseConfig");
  const auto create = egl.Get<EglHandle (*)(EglHandle, EglHandle, EglHandle, const std::int32_t*)>("eglCreateContext");
  const auto destroy = egl.Get<unsigned (*)(EglHandle, EglHandle)>("eglDestroyContext");
  const auto make_current = egl.Get<unsigned (*)(EglHandle, EglHandle, EglHandle, EglHandle)>("eglMakeCurrent");

  Require(get_display != nullptr, "eglGetPlatformDisplayEXT");
  const EglHandle display = get_display(kEglPlatformSurfaceless, nullptr, nullptr);
  Require(display != nullptr, "eglGetPlatformDisplay (surfaceless)");
  Require(initialize(display, nullptr, nullptr), "eglInitialize (surfaceless)");
  Require(bind_api(kEglOpenGlApi), "eglBindAPI (OpenGL)");
  const std::array<std::int32_t, 5> wanted{kEglSurfaceType, 0, kEglRenderableType, kEglOpenGlBit, kEglNone};
  EglHandle config = nullptr;
  std::int32_t found = 0;
  Require(choose(display, wanted.data(), &config, 1, &found) && found == 1, "eglChooseConfig (OpenGL)");
  const EglHandle context = create(display, config, nullptr, nullptr);
  Require(context != nullptr, "eglCreateContext (OpenGL)");

  get_ = get_proc;
  // The API is bound per thread. The display is never terminated, because all contexts of the process share it.
  make_current_ = [=] {
    Require(bind_api(kEglOpenGlApi) && make_current(display, nullptr, nullptr, context), "eglMakeCurrent");
  };
  release_ = [=] { make_current(display, nullptr, nullptr, nullptr); };
  destroy_ = [=] { destroy(display, context); };
  const Current current(*this);
  name_ = "EGL: " + RendererName(reinterpret_cast<GetString>(get_proc("glGetString")));
}

void GlContext::OpenOsmesa() {
  const Library osmesa("libOSMesa.so.8");
  const auto create = osmesa.Get<void* (*)(unsigned, int, int, int, void*)>("OSMesaCreateContextExt");
  const auto destroy = osmesa.Get<void (*)(void*)>("OSMesaDestroyContext");
  const auto make_current = osmesa.Get<unsigned char (*)(void*, void*, unsigned, int, int)>("OSMesaMakeCurrent");
  const auto get_proc = osmesa.Get<void* (*)(const char*)>("OSMesaGetProcAddress");

  void* context = create(kOsmesaRgba, 24, 8, 0, nullptr);
  Require(context != nullptr, "OSMesaCreateContextExt");
  get_ = get_proc;
  // OSMesa needs a colour buffer. MuJoCo draws into a buffer of its own, so one pixel is enough.
  const auto pixel = std::make_shared<std::array<std::uint8_t, 4>>();
  make_current_ = [=] {
    Require(make_current(context, pixel->data(), kOsmesaUnsignedByte, 1, 1), "OSMesaMakeCurrent");
  };
  release_ = [=] { make_current(nullptr, nullptr, kOsmesaUnsignedByte, 0, 0); };
  destroy_ = [=] { destroy(context); };
  const Current current(*this);
  name_ = "OSMesa: " + RendererName(reinterpret_cast<GetString>(get_proc("glGetString")));
}

GlContext::GlContext(Gl gl) {
  PinRasteriser();
  struct BackEnd {
    Gl gl;
    const char* name;
    void (GlContext::*open)();
  };
  std::string tried;
  for (const BackEnd& back_end :
       {BackEnd{Gl::kEgl, "EGL", &GlContext::OpenEgl}, BackEnd{Gl::kOsmesa, "OSMesa", &GlContext::OpenOsmesa}}) {
    if (gl != Gl::kAuto && gl != back_end.gl) continue;
    tried += (tried.empty() ? "" : "; ") + std::string(back_end.name) + ": ";
    try {
      (this->*back_end.open)();
      if (Claim(back_end.gl)) return;
      tried += "this process already draws with the other back end";
    } catch (const MachineError& error) {
      tried += error.what();
    }
    destroy_();
    destroy_ = [] {};
  }
  throw MachineError("cannot draw pictures without a display: no OpenGL back end works (" + tried + ")");
}

GlContext::~GlContext() { destroy_(); }

}  // namespace merlin::sim
