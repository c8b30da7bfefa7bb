#include "robot/emulated/depth_wire.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstring>
#include <type_traits>

namespace merlin {
namespace {

static_assert(std::endian::native == std::endian::little, "numbers go over the wire as they lie in memory");

constexpr std::array<std::uint8_t, 6> kMagicAndVersion{'M', 'P', 'M', 'D', 1, 0};
constexpr std::size_t kHeaderBytes = 12;
constexpr std::size_t kSettingsBytes = 12;
constexpr std::size_t kFrameHeadBytes = 2 + 2 + 8 + kSettingsBytes;
constexpr std::size_t kPixelBytes = 4 + 4 + 1 + 1;
constexpr std::size_t kPixelsMax = 512 * 512;
constexpr std::size_t kFrequenciesMax = 8;
constexpr std::size_t kHelloHeadBytes = 2 + 2 + 3 * 4 + kSettingsBytes + 8 * 8;
constexpr std::size_t kTextMax = 256;
constexpr std::size_t kPayloadMax = kFrameHeadBytes + kPixelBytes * kPixelsMax;

struct Writer {
  std::vector<std::uint8_t> bytes;

  template <class Number>
  void operator()(const Number& number) {
    if constexpr (std::is_same_v<Number, WireSettings>) {
      (*this)(number.integration_us), (*this)(number.frequency_hz), (*this)(number.second_frequency_hz);
    } else {
      Append(&number, sizeof number);
    }
  }
  template <class Item>
  void operator()(const std::vector<Item>& items) {
    Append(items.data(), items.size() * sizeof(Item));
  }
  void Append(const void* data, std::size_t size) {
    const auto* const begin = static_cast<const std::uint8_t*>(data);
    bytes.insert(bytes.end(), begin, begin + size);
  }
};

// Reads a payload whose length has been checked.
struct Reader {
  std::span<const std::uint8_t> bytes;

  template <class Number>
  void operator()(Number& number) {
    if constexpr (std::is_same_v<Number, WireSettings>) {
      (*this)(number.integration_us), (*this)(number.frequency_hz), (*this)(number.second_frequency_hz);
    } else {
      Take(&number, sizeof number);
    }
  }
  template <class Item>
  void operator()(std::vector<Item>& items) {
    Take(items.data(), items.size() * sizeof(Item));
  }
  void Take(void* data, std::size_t size) {
    if (size > 0) std::memcpy(data, bytes.data(), size);
    bytes = bytes.subspan(size);
  }
};

struct PayloadWriter {
  Writer& write;

  void operator()(const WireHello& hello) {
    const CameraModel& c = hello.camera;
    write(static_cast<std::uint16_t>(c.width)), write(static_cast<std::uint16_t>(c.height));
    write(hello.integration_min_us), write(hello.integration_max_us);
    write(static_cast<std::uint32_t>(hello.frequencies_hz.size())), write(hello.frequencies_hz);
    write(hello.settings);
    for (const double number : {c.fx_px, c.fy_px, c.cx_px, c.cy_px, c.k1, c.k2, c.p1, c.p2}) write(number);
  }
  void operator()(const WireFrame& frame) {
    write(frame.columns), write(frame.rows), write(frame.stamp_ns), write(frame.settings);
    write(frame.range_m), write(frame.amplitude), write(frame.intensity), write(frame.flags);
  }
  void operator()(const WireSet& set) { write(set.settings); }
  void operator()(const WireRefused& refused) {
    write.Append(refused.why.data(), std::min(refused.why.size(), kTextMax));
  }
  void operator()(const WireUpdate&) {}
  void operator()(const WireDone&) {}
};

bool IsSize(unsigned int columns, unsigned int rows) {
  return columns > 0 && rows > 0 && static_cast<std::size_t>(columns) * rows <= kPixelsMax;
}

std::optional<WireMessage> ReadHello(std::span<const std::uint8_t> payload) {
  if (payload.size() < kHelloHeadBytes) return std::nullopt;
  Reader read{payload};
  std::uint16_t columns, rows;
  std::uint32_t count;
  WireHello hello;
  read(columns), read(rows), read(hello.integration_min_us), read(hello.integration_max_us), read(count);
  if (!IsSize(columns, rows) || count == 0 || count > kFrequenciesMax) return std::nullopt;
  if (hello.integration_min_us > hello.integration_max_us || payload.size() != kHelloHeadBytes + 4 * count)
    return std::nullopt;
  hello.frequencies_hz.resize(count);
  CameraModel& c = hello.camera;
  c.width = columns, c.height = rows;
  read(hello.frequencies_hz), read(hello.settings);
  for (double* number : {&c.fx_px, &c.fy_px, &c.cx_px, &c.cy_px, &c.k1, &c.k2, &c.p1, &c.p2}) {
    read(*number);
    if (!std::isfinite(*number)) return std::nullopt;
  }
  return hello;
}

std::optional<WireMessage> ReadFrame(std::span<const std::uint8_t> payload) {
  if (payload.size() < kFrameHeadBytes) return std::nullopt;
  Reader read{payload};
  WireFrame frame;
  read(frame.columns), read(frame.rows), read(frame.stamp_ns), read(frame.settings);
  if (!IsSize(frame.columns, frame.rows)) return std::nullopt;
  const std::size_t pixels = static_cast<std::size_t>(frame.columns) * frame.rows;
  if (payload.size() != kFrameHeadBytes + kPixelBytes * pixels) return std::nullopt;
  frame.range_m.resize(pixels), frame.amplitude.resize(pixels);
  frame.intensity.resize(pixels), frame.flags.resize(pixels);
  read(frame.range_m), read(frame.amplitude), read(frame.intensity), read(frame.flags);
  return frame;
}

std::optional<WireMessage> ReadPayload(unsigned int kind, std::span<const std::uint8_t> payload) {
  switch (kind) {
    case 1:
      return ReadHello(payload);
    case 2:
      return payload.empty() ? std::optional<WireMessage>(WireUpdate{}) : std::nullopt;
    case 3:
      return ReadFrame(payload);
    case 4: {
      if (payload.size() != kSettingsBytes) return std::nullopt;
      WireSet set;
      Reader{payload}(set.settings);
      return set;
    }
    case 5:
      return payload.empty() ? std::optional<WireMessage>(WireDone{}) : std::nullopt;
    case 6:
      if (payload.size() > kTextMax) return std::nullopt;
      return WireRefused{std::string(payload.begin(), payload.end())};
    default:
      return std::nullopt;
  }
}

}  // namespace

std::vector<std::uint8_t> Encode(const WireMessage& message) {
  Writer payload, whole;
  std::visit(PayloadWriter{payload}, message);
  whole.Append(kMagicAndVersion.data(), kMagicAndVersion.size());
  whole(static_cast<std::uint16_t>(message.index() + 1));
  whole(static_cast<std::uint32_t>(payload.bytes.size()));
  whole(payload.bytes);
  return std::move(whole.bytes);
}

WireReading Decode(std::span<const std::uint8_t> bytes) {
  const WireReading garbage{.kind = WireReading::Kind::kGarbage, .bytes = 0, .message = std::nullopt};
  const std::size_t known = std::min(bytes.size(), kMagicAndVersion.size());
  if (!std::equal(bytes.begin(), bytes.begin() + static_cast<std::ptrdiff_t>(known), kMagicAndVersion.begin()))
    return garbage;
  if (bytes.size() < kHeaderBytes) return {};
  Reader read{bytes.subspan(kMagicAndVersion.size())};
  std::uint16_t kind;
  std::uint32_t size;
  read(kind), read(size);
  if (size > kPayloadMax) return garbage;
  if (bytes.size() < kHeaderBytes + size) return {};
  std::optional<WireMessage> message = ReadPayload(kind, bytes.subspan(kHeaderBytes, size));
  if (!message) return garbage;
  return {.kind = WireReading::Kind::kMessage, .bytes = kHeaderBytes + size, .message = std::move(message)};
}

}  // namespace merlin
