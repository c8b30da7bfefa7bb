// The errors a boundary (file, wire, user, device) may raise. Each is one sentence: where, what, expected, got.
#pragma once

#include <stdexcept>
#include <string>

namespace merlin {

// The input is wrong: bad usage, file, key or value. Programs exit with 2.
class InputError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
  // where: "scenarios/x.yaml:12" or "--seed"; expected and got may be empty.
  InputError(const std::string& where, const std::string& what, const std::string& expected = "",
             const std::string& got = "")
      : std::runtime_error(where + ": " + what + (expected.empty() ? "" : "; expected " + expected) +
                           (got.empty() ? "" : ", got " + got)) {}
};

// The input is right, but this machine cannot do what it asks for: no GL, no device, disk full. Programs exit with 3.
class MachineError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

// A device failed while the car was in use. Programs exit with 1, once the car stands.
class DeviceError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

}  // namespace merlin
