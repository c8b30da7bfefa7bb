// A rover's URDF with changes, and the messages about it.
#pragma once

#include <gtest/gtest.h>

#include <algorithm>
#include <string>
#include <vector>

#include "robot/base/error.h"
#include "robot/description/description.h"
#include "tests/robot/description/foreign_cars.h"

namespace merlin::car_text {

// The text with the first `from` replaced; from must be there.
inline std::string Replaced(std::string text, const std::string& from, const std::string& to) {
  const std::size_t at = text.find(from);
  EXPECT_NE(at, std::string::npos) << from;
  return at == std::string::npos ? text : text.replace(at, from.size(), to);
}

// Counted from 1.
inline int LineOf(const std::string& text, const std::string& part) {
  const std::size_t at = text.find(part);
  EXPECT_NE(at, std::string::npos) << part;
  return 1 + static_cast<int>(std::count(text.begin(), text.begin() + static_cast<std::ptrdiff_t>(at), '\n'));
}

inline std::string At(const std::string& text, const std::string& part) {
  return "car.urdf:" + std::to_string(LineOf(text, part)) + ": ";
}

// The rover with this URDF and mapping in a temporary folder.
class Rover {
 public:
  explicit Rover(const std::string& urdf, const std::string& mapping = kRoverMapping) {
    WriteRover(files_);
    files_.Write("car.urdf", urdf);
    files_.Write("car.mapping.yaml", mapping);
  }
  const ForeignCar& files() const { return files_; }
  CarDescription Read() const { return ReadCar(files_.urdf()); }
  // The message of the InputError; empty if there is none.
  std::string Error() const {
    try {
      Read();
    } catch (const InputError& error) {
      return error.what();
    }
    return "";
  }

 private:
  ForeignCar files_;
};

inline void ExpectSays(const std::string& text, const std::vector<std::string>& parts) {
  for (const std::string& part : parts)
    EXPECT_NE(text.find(part), std::string::npos) << "'" << part << "' not in: " << text;
}

// Expects one fault whose message contains all of these.
inline void ExpectFault(const std::string& urdf, const std::vector<std::string>& parts) {
  const std::string text = Rover(urdf).Error();
  ExpectSays(text, parts);
  EXPECT_EQ(text.find('\n'), std::string::npos) << text;
}

}  // namespace merlin::car_text
