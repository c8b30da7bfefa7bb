#include "robot/hardware/depth/shared_library.h"

#include <dlfcn.h>
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <filesystem>

#include "robot/base/error.h"

namespace merlin {

SharedLibrary::SharedLibrary(const std::string& path) : path_(path) {
  std::error_code error;
  if (!std::filesystem::is_regular_file(path, error)) throw InputError(path, "no such library");
  // An absolute path: a bare file name would be looked for in the system's folders.
  library_ = dlopen(std::filesystem::absolute(path).c_str(), RTLD_NOW | RTLD_LOCAL);
  if (library_ == nullptr) throw InputError(path, fmt::format("cannot be opened as a shared library ({})", dlerror()));
}

SharedLibrary::~SharedLibrary() { dlclose(library_); }

void* SharedLibrary::Symbol(const char* name) {
  void* const symbol = dlsym(library_, name);
  if (symbol == nullptr) missing_.emplace_back(name);
  return symbol;
}

void SharedLibrary::RequireAll() const {
  if (!missing_.empty()) throw InputError(path_, fmt::format("the library lacks {}", fmt::join(missing_, ", ")));
}

}  // namespace merlin
