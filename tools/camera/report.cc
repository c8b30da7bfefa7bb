#include "tools/camera/report.h"

#include <fmt/format.h>

#include <nlohmann/json.hpp>

#include "tools/json_text.h"

namespace merlin {
namespace {

using Json = nlohmann::ordered_json;

Json Number(const std::optional<double>& value) { return value ? Json(*value) : Json(nullptr); }

Json ToJson(const RangeStatistics& statistics) {
  return {{"range_mean_m", Number(statistics.mean_m)},
          {"range_sigma_m", Number(statistics.sigma_m)},
          {"samples", statistics.samples}};
}

std::string Line(const char* what, const RangeStatistics& statistics) {
  if (!statistics.mean_m) return fmt::format("  {:<22} no valid sample\n", what);
  const std::string sigma = statistics.sigma_m ? fmt::format("{:.2f} mm", 1e3 * *statistics.sigma_m) : "unknown";
  return fmt::format("  {:<22} mean {:.4f} m, sigma {}, {} samples\n", what, *statistics.mean_m, sigma,
                     statistics.samples);
}

}  // namespace

std::string ToJson(const Measurement& m, const Shooting& shooting, const std::string& effects) {
  const DepthSettings& settings = shooting.settings;
  Json frequencies{settings.frequency_hz};
  if (settings.second_frequency_hz > 0.0) frequencies.push_back(settings.second_frequency_hz);
  const Json json{{"model", shooting.sheet.name},
                  {"settings",
                   {{"integration_s", settings.integration_s},
                    {"frequencies_hz", frequencies},
                    {"effects", effects},
                    {"frames", shooting.frames},
                    {"seed", shooting.seed}}},
                  {"center", ToJson(m.center)},
                  {"middle", ToJson(m.middle)},
                  {"valid_share", m.valid_share},
                  {"saturated_share", m.saturated_share},
                  {"amplitude_mean", m.amplitude_mean},
                  {"frame_ms", m.frame_ms}};
  return JsonText(json);
}

std::string SettingsLine(const Shooting& shooting, const std::string& effects) {
  const DepthSettings& settings = shooting.settings;
  const std::string second =
      settings.second_frequency_hz > 0.0 ? fmt::format(" + {:g}", settings.second_frequency_hz * 1e-6) : "";
  return fmt::format("{} frame{} of {:g} us at {:g}{} MHz, effects {}, seed {}", shooting.frames,
                     shooting.frames == 1 ? "" : "s", settings.integration_s * 1e6, settings.frequency_hz * 1e-6,
                     second, effects, shooting.seed);
}

std::string Summary(const Measurement& m) {
  const double wrap_m = UnambiguousRange_m(m.last.settings);
  std::string text = m.true_center_m > 0.0 ? fmt::format("  {:<22} {:.4f} m, wraps at {:.3f} m\n", "true range, centre",
                                                         m.true_center_m, wrap_m)
                                           : fmt::format("  {:<22} nothing there\n", "true range, centre");
  text += Line("centre pixel", m.center) + Line("middle ninth", m.middle);
  text += fmt::format("  {:<22} {:.2f} %, saturated {:.2f} %, amplitude {:.0f} e (mean of the valid)\n", "valid pixels",
                      100.0 * m.valid_share, 100.0 * m.saturated_share, m.amplitude_mean);
  text += fmt::format("  {:<22} {:.2f} ms (median)\n", "one frame takes", m.frame_ms);
  return text +
         "  sigma is temporal, each pixel's about its own mean; ranges are unwrapped about the true\n  ones, less the "
         "whole wraps of the centre's\n";
}

}  // namespace merlin
