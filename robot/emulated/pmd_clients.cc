#include "robot/emulated/pmd_clients.h"

#include <sys/socket.h>
#include <sys/time.h>
#include <unistd.h>

#include <algorithm>
#include <cstring>
#include <exception>

#include "robot/base/error.h"

namespace merlin {
namespace {

constexpr int kError = 1;
constexpr timeval kAnswerLimit{.tv_sec = 2, .tv_usec = 0};

}  // namespace

PmdClient::PmdClient(const std::string& path) : socket_(ConnectTo(path)), connection_(socket_) {
  ::setsockopt(socket_, SOL_SOCKET, SO_RCVTIMEO, &kAnswerLimit, sizeof kAnswerLimit);
  std::optional<WireHello> hello = As<WireHello>(connection_.Receive());
  if (!hello) {
    ::close(socket_);
    throw MachineError(path + ": the program that answers there is not an emulated camera");
  }
  hello_ = std::move(*hello);
}

PmdClient::~PmdClient() { ::close(socket_); }

template <class Answer>
Answer PmdClient::Ask(const WireMessage& request) {
  std::optional<WireMessage> answer;
  if (connection_.Send(request)) answer = connection_.Receive();
  if (!answer) throw MachineError("the camera is gone");
  if (const auto* const refused = std::get_if<WireRefused>(&*answer)) throw MachineError(refused->why);
  if (!std::holds_alternative<Answer>(*answer)) throw MachineError("the camera sent an unexpected answer");
  return std::get<Answer>(std::move(*answer));
}

void PmdClient::Update() { frame_ = Ask<WireFrame>(WireUpdate{}); }

void PmdClient::Set(const WireSettings& settings) {
  Ask<WireDone>(WireSet{settings});
  hello_.settings = settings;
}

const WireFrame& PmdClient::frame() const {
  if (!frame_) throw MachineError("no frame yet: update first");
  return *frame_;
}

int PmdClients::Open(PmdHandle* handle, const std::string& path) {
  std::string error;
  try {
    auto client = std::make_shared<PmdClient>(path);
    const std::lock_guard lock(mutex_);
    cameras_[++last_] = {std::move(client), ""};
    *handle = last_;
    return kPmdOk;
  } catch (const std::exception& failure) {
    error = failure.what();
  }
  const std::lock_guard lock(mutex_);
  open_error_ = error;
  return kError;
}

int PmdClients::Close(PmdHandle handle) {
  const std::lock_guard lock(mutex_);
  return cameras_.erase(handle) == 1 ? kPmdOk : kError;
}

int PmdClients::Do(PmdHandle handle, const std::function<void(PmdClient&)>& action) {
  std::shared_ptr<PmdClient> client;
  {
    const std::lock_guard lock(mutex_);
    const auto camera = cameras_.find(handle);
    if (camera == cameras_.end()) return kError;
    client = camera->second.client;
  }
  try {
    action(*client);
    return kPmdOk;
  } catch (const std::exception& failure) {
    const std::lock_guard lock(mutex_);
    const auto camera = cameras_.find(handle);
    if (camera != cameras_.end()) camera->second.error = failure.what();
    return kError;
  }
}

int PmdClients::LastError(PmdHandle handle, char* text, std::size_t bytes) {
  const std::lock_guard lock(mutex_);
  const auto camera = cameras_.find(handle);
  if (bytes == 0 || (handle != 0 && camera == cameras_.end())) return kError;
  const std::string& error = handle == 0 ? open_error_ : camera->second.error;
  const std::size_t length = std::min(error.size(), bytes - 1);
  std::memcpy(text, error.data(), length);
  text[length] = '\0';
  return kPmdOk;
}

void CopyOut(const void* image, std::size_t image_bytes, void* memory, std::size_t memory_bytes) {
  if (memory_bytes < image_bytes)
    throw MachineError("the memory is too small: " + std::to_string(memory_bytes) + " bytes for an image of " +
                       std::to_string(image_bytes));
  std::memcpy(memory, image, image_bytes);
}

}  // namespace merlin
