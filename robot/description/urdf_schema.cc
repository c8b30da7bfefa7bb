#include "robot/description/urdf_schema.h"

#include <fmt/format.h>

#include <charconv>
#include <cmath>
#include <sstream>

namespace merlin {
namespace {

constexpr bool kRequired = true;

UrdfElement Geometry() { return {"geometry", {}, {}, Occurs::kOnce}; }  // its children: UrdfShapes

UrdfElement Material() { return {"material", {{"name", 0, kRequired}}, {{"color", {{"rgba", 4, kRequired, true}}}}}; }

UrdfElement Link() {
  const UrdfElement origin{"origin", {{"xyz", 3}, {"rpy", 3}}};
  const UrdfElement mass{"mass", {{"value", 1, kRequired}}, {}, Occurs::kOnce};
  UrdfElement inertia{"inertia", {}, {}, Occurs::kOnce};
  for (const char* moment : {"ixx", "ixy", "ixz", "iyy", "iyz", "izz"})
    inertia.attributes.push_back({moment, 1, kRequired});
  return {"link",
          {{"name", 0, kRequired}},
          {{"inertial", {}, {origin, mass, inertia}},
           {"visual", {}, {origin, Geometry(), Material()}},
           {"collision", {}, {origin, Geometry()}}}};
}

UrdfElement Joint() {
  return {"joint",
          {{"name", 0, kRequired}, {"type", 0, kRequired}},
          {{"origin", {{"xyz", 3}, {"rpy", 3}}},
           {"parent", {{"link", 0, kRequired}}, {}, Occurs::kOnce},
           {"child", {{"link", 0, kRequired}}, {}, Occurs::kOnce},
           {"axis", {{"xyz", 3}}},
           {"limit", {{"lower", 1}, {"upper", 1}, {"effort", 1, kRequired}, {"velocity", 1, kRequired}}},
           {"dynamics", {{"damping", 1}, {"friction", 1}}},
           {"mimic", {{"joint", 0, kRequired}, {"multiplier", 1}, {"offset", 1}}}}};
}

}  // namespace

const UrdfElement& UrdfRobot() {
  static const UrdfElement kRobot{"robot", {{"name", 0, kRequired}}, {Link(), Joint(), Material()}};
  return kRobot;
}

const std::vector<UrdfElement>& UrdfShapes() {
  static const std::vector<UrdfElement> kShapes{{"box", {{"size", 3, kRequired}}},
                                                {"cylinder", {{"radius", 1, kRequired}, {"length", 1, kRequired}}},
                                                {"sphere", {{"radius", 1, kRequired}}},
                                                {"mesh", {{"filename", 0, kRequired}, {"scale", 3}}}};
  return kShapes;
}

bool AreNumbers(const std::string& text, const UrdfAttribute& attribute) {
  std::istringstream words(text);
  std::size_t count = 0;
  for (std::string word; words >> word; ++count) {
    const char* begin = word.c_str() + (word[0] == '+' ? 1 : 0);
    double number = 0.0;
    const auto [rest, error] = std::from_chars(begin, word.c_str() + word.size(), number);
    if (error != std::errc() || *rest != '\0' || !std::isfinite(number)) return false;
    if (attribute.is_share && !(number >= 0.0 && number <= 1.0)) return false;
  }
  return count == attribute.numbers;
}

std::string Expected(const UrdfAttribute& attribute) {
  if (attribute.is_share) return fmt::format("{} numbers from 0 to 1", attribute.numbers);
  return attribute.numbers == 1 ? "a finite number" : fmt::format("{} finite numbers", attribute.numbers);
}

}  // namespace merlin
