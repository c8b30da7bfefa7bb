// The elements and attributes that URDF defines, as far as a car is made of them (http://wiki.ros.org/urdf/XML).
#pragma once

#include <cstddef>
#include <string>
#include <vector>

namespace merlin {

struct UrdfAttribute {
  const char* name;
  std::size_t numbers = 0;  // how many it holds; 0: text
  bool required = false;
  bool is_share = false;  // each number is from 0 to 1
};

enum class Occurs { kAny, kOnce };

struct UrdfElement {
  const char* name;
  std::vector<UrdfAttribute> attributes;
  std::vector<UrdfElement> children{};
  Occurs occurs = Occurs::kAny;
};

constexpr char kShapeNames[] = "<box>, <cylinder>, <sphere> or <mesh>";

const UrdfElement& UrdfRobot();
const std::vector<UrdfElement>& UrdfShapes();

// Whether the text holds as many finite numbers, separated by white space, as the attribute needs; and a description of
// what it should hold.
bool AreNumbers(const std::string& text, const UrdfAttribute& attribute);
std::string Expected(const UrdfAttribute& attribute);

}  // namespace merlin
