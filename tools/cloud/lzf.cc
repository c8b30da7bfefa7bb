#include "tools/cloud/lzf.h"

#include <cstdint>

#include "robot/base/error.h"

namespace merlin {

std::string DecompressLzf(std::string_view data, std::size_t size, std::size_t offset, const std::string& name) {
  std::string out;
  std::size_t at = 0;
  const auto refuse = [&](const std::string& what, const std::string& expected = "", const std::string& got = "") {
    throw InputError(name + ": byte " + std::to_string(offset + at), what, expected, got);
  };
  const auto next = [&]() -> std::size_t {
    if (at == data.size()) refuse("the compressed data end within a run");
    return static_cast<std::uint8_t>(data[at++]);
  };
  while (at < data.size()) {
    const std::size_t control = next();
    std::size_t length = control < 32 ? control + 1 : control >> 5;
    if (control < 32) {
      if (length > data.size() - at) refuse("the compressed data end within a run");
    } else {
      if (length == 7) length += next();
      length += 2;
    }
    if (length > size - out.size()) refuse("the compressed data give more bytes than they say", std::to_string(size));
    if (control < 32) {
      out.append(data.substr(at, length));
      at += length;
      continue;
    }
    const std::size_t back = ((control & 31) << 8) + next() + 1;
    if (back > out.size()) refuse("the compressed data repeat what is before their start");
    for (std::size_t from = out.size() - back; length > 0; --length) out += out[from++];
  }
  if (out.size() < size)
    refuse("the compressed data give fewer bytes than they say", std::to_string(size), std::to_string(out.size()));
  return out;
}

}  // namespace merlin
