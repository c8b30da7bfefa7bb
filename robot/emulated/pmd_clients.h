// The cameras that a vendor library has open, each a connection to the twin's DepthServer. Both generations of the
// calls are built on this. Errors become texts, as in a real vendor library.
#pragma once

#include <functional>
#include <map>
#include <memory>
#include <mutex>
#include <optional>
#include <string>

#include "robot/emulated/depth_connection.h"
#include "robot/protocol/pmd_api.h"

namespace merlin {

// Used by one thread at a time, like the real library. Throws MachineError.
class PmdClient {
 public:
  explicit PmdClient(const std::string& path);
  ~PmdClient();
  PmdClient(const PmdClient&) = delete;
  PmdClient& operator=(const PmdClient&) = delete;

  void Update();
  void Set(const WireSettings& settings);
  const WireHello& hello() const { return hello_; }  // with the settings in force
  const WireFrame& frame() const;                    // of the last update
  const WireFrame* last_frame() const { return frame_ ? &*frame_ : nullptr; }

 private:
  template <class Answer>
  Answer Ask(const WireMessage& request);

  int socket_;
  DepthConnection connection_;
  WireHello hello_;
  std::optional<WireFrame> frame_;
};

class PmdClients {
 public:
  int Open(PmdHandle* handle, const std::string& path);
  int Close(PmdHandle handle);
  // Calls action. Returns 0, or 1 if action throws or there is no such camera; LastError then has the text.
  int Do(PmdHandle handle, const std::function<void(PmdClient&)>& action);
  int LastError(PmdHandle handle, char* text, std::size_t bytes);

 private:
  struct Camera {
    std::shared_ptr<PmdClient> client;
    std::string error;
  };
  std::mutex mutex_;
  PmdHandle last_ = 0;
  std::map<PmdHandle, Camera> cameras_;
  std::string open_error_;
};

// Copies an image into the caller's memory. Throws MachineError if it does not fit.
void CopyOut(const void* image, std::size_t image_bytes, void* memory, std::size_t memory_bytes);

}  // namespace merlin
