// A shared library that is opened at run time. Its calls are found by name.
#pragma once

#include <string>
#include <vector>

namespace merlin {

class SharedLibrary {
 public:
  // Throws InputError for a file that does not exist or is not a library.
  explicit SharedLibrary(const std::string& path);
  ~SharedLibrary();
  SharedLibrary(const SharedLibrary&) = delete;
  SharedLibrary& operator=(const SharedLibrary&) = delete;

  // Null for a call that the library lacks. RequireAll then names all of them.
  template <class Function>
  void Find(const char* name, Function*& call) {
    call = reinterpret_cast<Function*>(Symbol(name));
  }
  // Throws InputError naming every call that Find did not find.
  void RequireAll() const;

  const std::string& path() const { return path_; }

 private:
  void* Symbol(const char* name);

  std::string path_;
  void* library_;
  std::vector<std::string> missing_;
};

}  // namespace merlin
