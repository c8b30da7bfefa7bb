// An OpenGL context without a window, from libraries opened at run time: a machine without them still runs the rest.
// EGL on Mesa's surfaceless platform (EGL_MESA_platform_surfaceless, EGL_KHR_surfaceless_context) or OSMesa.
#pragma once

#include <functional>
#include <string>

#include "sim/color/renderer.h"

namespace merlin::sim {

class GlContext {
 public:
  // kAuto: EGL, else OSMesa. Throws MachineError, naming each back end tried and why it failed.
  explicit GlContext(Gl gl);
  ~GlContext();
  GlContext(const GlContext&) = delete;
  GlContext& operator=(const GlContext&) = delete;

  // "EGL: llvmpipe (LLVM 15.0.6, 256 bits)"
  const std::string& name() const { return name_; }
  // A function of GL by its name; null: it has none such.
  void* Get(const char* function) const { return get_(function); }

  // Holds the context current in the calling thread, for as long as it lives: a context is current in one thread at a
  // time, and the next to draw may be another thread.
  class Current {
   public:
    explicit Current(const GlContext& context) : context_(context) { context_.make_current_(); }
    ~Current() { context_.release_(); }
    Current(const Current&) = delete;
    Current& operator=(const Current&) = delete;

   private:
    const GlContext& context_;
  };

 private:
  void OpenEgl();
  void OpenOsmesa();

  std::function<void*(const char*)> get_;
  std::function<void()> make_current_;
  std::function<void()> release_ = [] {};
  std::function<void()> destroy_ = [] {};
  std::string name_;
};

}  // namespace merlin::sim
