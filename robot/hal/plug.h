// A plug joins the stack to one kind of robot: the twin, the twin behind its real drivers, the real car, a recording. It
// owns the devices, and says what it can and cannot do; the runner (scenarios/run/run.h) knows plugs by this alone. A new
// plug is one pair of files in scenarios/run/.
#pragma once

#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "robot/hal/hal.h"
#include "robot/types/ground_truth.h"

namespace merlin {

struct PlugTraits {
  bool knows_truth = false;  // false: checks that need the truth are not judged
  bool repeats = false;      // the same scenario and seed give the same bits: hashes mean something
  bool world_waits =
      false;  // Clock::WaitUntil steps the world; false: the clock runs, whether the stack is ready or not
};

class Plug {
 public:
  virtual ~Plug() = default;

  virtual PlugTraits traits() const = 0;
  // Valid as long as the plug.
  virtual Robot robot() = 0;

  // Called when a depth frame of this stamp was delivered: keeps the truth of that instant.
  virtual void Keep(Time /*stamp*/) {}
  // Called at every tick. Returns in one sentence why the run must end now, for instance because the car lies on its
  // side; empty: the run goes on. Throws the error that stopped the world, if any.
  virtual std::string ReasonToEnd() { return ""; }
  // What is wrong now with each device that is not well, one sentence each.
  virtual std::vector<std::string> Complaints() const { return {}; }

  // Called once, when the loop is over. A world that follows the clock stops here. Empty: the truth is not known.
  virtual std::optional<GroundTruth> Truth() { return std::nullopt; }

  // For the report: what the user should know, one sentence each; what draws the colour pictures (empty: nothing does);
  // names and versions of the libraries that this plug alone needs.
  virtual std::vector<std::string> notes() const { return {}; }
  virtual std::string renderer() const { return ""; }
  virtual std::vector<std::pair<std::string, std::string>> versions() const { return {}; }
};

}  // namespace merlin
