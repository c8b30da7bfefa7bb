#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <string_view>

#include "robot/types/error.h"
#include "robot/types/nearest_name.h"
#include "sim/tof/tof_camera.h"

namespace merlin::sim {
namespace {

struct Effect {
  std::string_view name;
  bool TofEffects::*on;
};
constexpr std::array kEffects{Effect{"noise", &TofEffects::noise}, Effect{"saturation", &TofEffects::saturation}};
constexpr TofEffects kIdeal{.noise = false, .saturation = false};

std::string_view Trim(std::string_view text) {
  const auto first = text.find_first_not_of(" \t");
  return first == text.npos ? "" : text.substr(first, text.find_last_not_of(" \t") - first + 1);
}

[[noreturn]] void ThrowUnknown(std::string_view name) {
  std::vector<std::string_view> known{"all", "ideal"};
  for (const Effect& effect : kEffects) known.push_back(effect.name);
  throw InputError("effects", fmt::format("unknown effect '{}'", name),
                   fmt::format("'{}' (known: {})", NearestName(name, known), fmt::join(known, ", ")));
}

void Apply(std::string_view word, TofEffects& effects) {
  const bool on = !word.starts_with('-');
  const std::string_view name = on ? word : word.substr(1);
  const auto effect = std::ranges::find(kEffects, name, &Effect::name);
  if (effect != kEffects.end()) {
    effects.*(effect->on) = on;
  } else if (word == "all") {
    effects = TofEffects{};
  } else if (word == "ideal") {
    effects = kIdeal;
  } else {
    ThrowUnknown(name);
  }
}

}  // namespace

TofEffects ParseTofEffects(const std::string& text) {
  std::string_view rest = text;
  // What is only taken out is taken out of all; what is only named is put into none.
  TofEffects effects = Trim(rest).starts_with('-') ? TofEffects{} : kIdeal;
  while (true) {
    const auto comma = rest.find(',');
    Apply(Trim(rest.substr(0, comma)), effects);
    if (comma == rest.npos) return effects;
    rest.remove_prefix(comma + 1);
  }
}

}  // namespace merlin::sim
