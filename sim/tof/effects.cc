#include "sim/tof/effects.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <vector>

#include "robot/base/error.h"
#include "robot/base/nearest_name.h"

namespace merlin::sim {
namespace {

constexpr std::array kEffects{
    TofEffectName{"noise", &TofEffects::noise},
    TofEffectName{"adc", &TofEffects::adc},
    TofEffectName{"wiggling", &TofEffects::wiggling},
    TofEffectName{"saturation", &TofEffects::saturation},
    TofEffectName{"sbi", &TofEffects::sbi},
    TofEffectName{"sunlight", &TofEffects::sunlight},
    TofEffectName{"intensity", &TofEffects::intensity},
    TofEffectName{"flying", &TofEffects::flying},
    TofEffectName{"motion", &TofEffects::motion},
    TofEffectName{"multipath", &TofEffects::multipath},
    TofEffectName{"glass", &TofEffects::glass},
    TofEffectName{"specular", &TofEffects::specular},
    TofEffectName{"scatter", &TofEffects::scatter},
    TofEffectName{"temperature", &TofEffects::temperature},
    TofEffectName{"fixed_pattern", &TofEffects::fixed_pattern},
    TofEffectName{"dead_pixels", &TofEffects::dead_pixels},
    TofEffectName{"lamp", &TofEffects::lamp},
};

std::string_view Trim(std::string_view text) {
  const auto first = text.find_first_not_of(" \t");
  return first == text.npos ? "" : text.substr(first, text.find_last_not_of(" \t") - first + 1);
}

[[noreturn]] void ThrowUnknown(std::string_view name) {
  std::vector<std::string_view> known{"all", "raw", "ideal"};
  for (const TofEffectName& effect : kEffects) known.push_back(effect.name);
  throw InputError("effects", fmt::format("unknown effect '{}'", name),
                   fmt::format("'{}' (known: {})", NearestName(name, known), fmt::join(known, ", ")));
}

void Apply(std::string_view word, TofEffects& effects) {
  const bool on = !word.starts_with('-');
  const std::string_view name = on ? word : word.substr(1);
  const auto effect = std::ranges::find(kEffects, name, &TofEffectName::name);
  if (effect != kEffects.end()) {
    effects.*(effect->on) = on;
  } else if (word == "all") {
    effects = TofEffects{};
  } else if (word == "raw") {
    effects = TofEffects{.calibrated = false};
  } else if (word == "ideal") {
    effects = kIdealTof;
  } else {
    ThrowUnknown(name);
  }
}

}  // namespace

std::span<const TofEffectName> TofEffectNames() { return kEffects; }

TofEffects ParseTofEffects(const std::string& text) {
  std::string_view rest = text;
  // A list that only removes effects starts from all; a list that only names effects starts from none.
  TofEffects effects = Trim(rest).starts_with('-') ? TofEffects{} : kIdealTof;
  while (true) {
    const auto comma = rest.find(',');
    Apply(Trim(rest.substr(0, comma)), effects);
    if (comma == rest.npos) return effects;
    rest.remove_prefix(comma + 1);
  }
}

}  // namespace merlin::sim
