// An OpenGL context without a window: EGL on Mesa's surfaceless platform (EGL_MESA_platform_surfaceless,
// EGL_KHR_surfaceless_context) or OSMesa. The libraries are opened at run time, so a machine without them still runs
// everything else.
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
  // Address of a GL function; null if there is no such function.
  void* Get(const char* function) const { return get_(function); }

  // Makes the context current in the calling thread for the lifetime of this object. A context is current in only one
  // thread at a time, and another thread may draw next.
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
