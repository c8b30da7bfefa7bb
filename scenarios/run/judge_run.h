// The judge's bench: what a run produced against what was true, as figures, hashes and files.
#pragma once

#include <cstdint>

#include "robot/base/first_fault.h"
#include "robot/base/sha256.h"
#include "robot/twin/twin.h"
#include "scenarios/judge/output_folder.h"
#include "scenarios/judge/result.h"
#include "scenarios/run/drive_loop.h"
#include "scenarios/run/truth.h"

namespace merlin {

// Hashes of the frames as they were delivered: stamps and buffers.
struct Evidence {
  Sha256 depth, color;
  std::int64_t depth_frames = 0, color_frames = 0;
  void Add(const DepthFrame& frame);
  void Add(const ColorFrame& frame);
};

// What only a simulation knows. Null: not known, and the figures that need it are null, too.
struct TrueWorld {
  const sim::World* world = nullptr;
  const Truth* truth = nullptr;
  bool repeats = false;  // the same bits every time: hashes mean something
};

// Writes trajectories and maps into the folder and fills in all figures but those of wall time. Checks are not
// evaluated. A file that cannot be written, or a figure that cannot be had, is left out, and the fault kept: the rest
// comes.
RunResult JudgeRun(const std::string& name, const Scenario& scenario, const Robot& robot, const TrueWorld& true_world,
                   const DriveLoop& loop, const Evidence& evidence, const OutputFolder& folder, FirstFault& faults);

}  // namespace merlin
