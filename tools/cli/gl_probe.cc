#include "tools/cli/gl_probe.h"

#if MERLIN_TWIN
#include <fcntl.h>
#include <fmt/core.h>
#include <mujoco/mujoco.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <cstring>
#include <exception>

#include "sim/color/renderer.h"
#endif

namespace merlin::cli {
#if MERLIN_TWIN
namespace {

// Draws an empty world; gives the renderer's name. Throws MachineError.
std::string DrawOnce(sim::Gl gl) {
  mjSpec* spec = mj_makeSpec();
  const mjModel* model = mj_compile(spec, nullptr);
  mjData* data = mj_makeData(model);
  mj_forward(model, data);
  const CameraModel camera{.width = 64, .height = 48, .fx_px = 60, .fy_px = 60, .cx_px = 31.5, .cy_px = 23.5};
  sim::Renderer renderer(model, camera, gl);
  sim::RenderSnapshot snapshot(model);
  snapshot.Take(model, data, Pose::Identity(), camera);
  std::vector<std::uint8_t> bgr(64 * 48 * 3);
  renderer.Draw(snapshot, bgr);
  return renderer.name();
}

// Runs in the child: writes '+' and the name, or '-' and the reason, into the pipe. Exits without clean-up, in which a
// broken driver might crash.
[[noreturn]] void ProbeInChild(sim::Gl gl, int pipe) {
  alarm(20);
  const int nowhere = open("/dev/null", O_WRONLY);
  dup2(nowhere, STDERR_FILENO);  // drivers write their complaints there
  std::string answer;
  try {
    answer = "+" + DrawOnce(gl);
  } catch (const std::exception& error) {
    answer = std::string("-") + error.what();
  }
  const bool told = write(pipe, answer.data(), answer.size()) == static_cast<ssize_t>(answer.size());
  _exit(told ? 0 : 1);
}

std::string ReadAll(int pipe) {
  std::string text;
  std::array<char, 512> part;
  for (ssize_t count; (count = read(pipe, part.data(), part.size())) > 0;)
    text.append(part.data(), static_cast<std::size_t>(count));
  return text;
}

GlProbe Probe(const std::string& backend, sim::Gl gl) {
  std::array<int, 2> ends;
  if (pipe(ends.data()) != 0) return {backend, false, std::strerror(errno)};
  const pid_t child = fork();
  if (child < 0) return {backend, false, std::strerror(errno)};
  if (child == 0) ProbeInChild(gl, ends[1]);
  close(ends[1]);
  const std::string answer = ReadAll(ends[0]);
  close(ends[0]);
  int status = 0;
  waitpid(child, &status, 0);
  if (!answer.empty()) return {backend, answer[0] == '+', answer.substr(1)};
  if (WIFSIGNALED(status) && WTERMSIG(status) == SIGALRM) return {backend, false, "no picture within 20 s"};
  if (WIFSIGNALED(status)) return {backend, false, fmt::format("the driver crashed (signal {})", WTERMSIG(status))};
  return {backend, false, "the driver ended the process"};
}

}  // namespace

std::vector<GlProbe> ProbeGl() { return {Probe("egl", sim::Gl::kEgl), Probe("osmesa", sim::Gl::kOsmesa)}; }
#else
std::vector<GlProbe> ProbeGl() { return {}; }
#endif

}  // namespace merlin::cli
