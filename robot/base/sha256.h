// SHA-256 of data that arrive in pieces.
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <string>
#include <string_view>
#include <type_traits>

namespace merlin {

class Sha256 {
 public:
  Sha256();  // throws MachineError where OpenSSL has no SHA-256
  ~Sha256();
  Sha256(Sha256&&) noexcept;
  Sha256& operator=(Sha256&&) noexcept;

  void Add(std::string_view bytes);
  // Adds the bytes of numbers, little-endian.
  template <class Number>
  requires std::is_arithmetic_v<Number>
  void Add(std::span<const Number> numbers) { AddLittleEndian(std::as_bytes(numbers)); }
  template <class Number>
  requires std::is_arithmetic_v<Number>
  void Add(Number number) { Add(std::span<const Number>(&number, 1)); }

  // The hash of all bytes added so far: 64 hexadecimal digits, lower case. More may be added afterwards.
  std::string Hex() const;

 private:
  void AddLittleEndian(std::span<const std::byte> bytes);

  struct Context;
  std::unique_ptr<Context> context_;
};

}  // namespace merlin
