#include "sim/actors/actor_config.h"

#include <fmt/format.h>

#include <algorithm>
#include <set>

#include "robot/base/error.h"
#include "robot/base/nearest_name.h"
#include "sim/actors/actor_body.h"

namespace merlin::sim {
namespace {

// Collects the faults of one actor, one sentence each.
class ActorCheck {
 public:
  explicit ActorCheck(const ActorConfig& actor) : actor_(actor) {
    CheckName();
    CheckBody();
    CheckPath();
    for (const double size_m : actor.size_m)
      if (!(size_m > 0.0 && std::isfinite(size_m)))
        Add("size_m", "expected positive lengths", fmt::format("{}", size_m));
    if (!(actor.wait_for_car_m >= 0.0 && std::isfinite(actor.wait_for_car_m)))
      Add("wait_for_car_m", "expected a length, 0 or more", fmt::format("{}", actor.wait_for_car_m));
  }
  const std::vector<std::string>& faults() const { return faults_; }

 private:
  void Add(const std::string& field, const std::string& rule, const std::string& got) {
    const std::string where = actor_.where.empty() ? "" : actor_.where + ": ";
    faults_.push_back(fmt::format("{}actor '{}': {}: {}, got {}", where, actor_.name, field, rule, got));
  }

  void CheckName() {
    const auto allowed = [](char c) {
      return (c >= '0' && c <= '9') || (c >= 'A' && c <= 'Z') || (c >= 'a' && c <= 'z') || c == '_' || c == '-';
    };
    if (actor_.name.empty() || !std::ranges::all_of(actor_.name, allowed))
      Add("name", "expected letters, digits, '_' and '-'", "'" + actor_.name + "'");
  }

  void CheckBody() {
    if (actor_.model.empty() == actor_.shape.empty())
      return Add("model, shape", "expected one of the two", actor_.model.empty() ? "none" : "both");
    if (!actor_.model.empty()) {
      if (!actor_.size_m.empty()) Add("size_m", "expected only together with a shape", "it with a model");
      if (!actor_.material.empty()) Add("material", "expected only together with a shape", "it with a model");
      return;
    }
    const std::vector<std::string>& shapes = ActorShapes();
    if (std::ranges::find(shapes, actor_.shape) == shapes.end())
      return Add("shape", fmt::format("unknown; did you mean '{}'?", NearestName(actor_.shape, shapes)),
                 "'" + actor_.shape + "'");
    const std::size_t count = SizesOf(actor_.shape);
    if (actor_.size_m.size() != count)
      Add("size_m",
          fmt::format("expected {} for a {}", count == 1 ? "1 length" : fmt::format("{} lengths", count), actor_.shape),
          fmt::format("{}", actor_.size_m.size()));
    else if (actor_.shape == "capsule" && !(actor_.size_m[1] > actor_.size_m[0]))
      Add("size_m", "expected a capsule higher than its diameter", fmt::format("{:g} m", actor_.size_m[1]));
  }

  void CheckPath() {
    const std::vector<std::vector<double>>& path = actor_.path;
    if (path.empty()) return Add("path", "expected one point or more", "none");
    for (std::size_t i = 0; i < path.size(); ++i) {
      const std::string field = fmt::format("path[{}]", i);
      if (path[i].size() < 3 || path[i].size() > 5)
        return Add(field, "expected [t_s, x_m, y_m], then yaw_rad, then z_m",
                   fmt::format("{} numbers", path[i].size()));
      if (path[i].size() != path[0].size())
        return Add(field, fmt::format("expected {} numbers, as the first point has", path[0].size()),
                   fmt::format("{}", path[i].size()));
      for (const double number : path[i])
        if (!std::isfinite(number)) return Add(field, "expected finite numbers", fmt::format("{}", number));
      if (path[i][0] < 0.0) return Add(field, "expected a time from 0 s on", fmt::format("{:g} s", path[i][0]));
      if (i > 0 && !(path[i][0] > path[i - 1][0]))
        return Add(field, fmt::format("expected a time after {:g} s", path[i - 1][0]),
                   fmt::format("{:g} s", path[i][0]));
    }
    if (actor_.until_s && !(*actor_.until_s > path[0][0]))
      Add("until_s", fmt::format("expected a time after it appears at {:g} s", path[0][0]),
          fmt::format("{:g} s", *actor_.until_s));
  }

  const ActorConfig& actor_;
  std::vector<std::string> faults_;
};

}  // namespace

void RefuseFaults(const std::vector<ActorConfig>& actors) {
  std::string all;
  const auto add = [&all](const std::string& fault) { all += (all.empty() ? "" : "\n") + fault; };
  std::set<std::string> names;
  for (const ActorConfig& actor : actors) {
    const ActorCheck check(actor);
    for (const std::string& fault : check.faults()) add(fault);
    if (!names.insert(actor.name).second)
      add(fmt::format("{}actor '{}': name: expected a name of its own, got that of another actor",
                      actor.where.empty() ? "" : actor.where + ": ", actor.name));
  }
  if (!all.empty()) throw InputError(all);
}

}  // namespace merlin::sim
