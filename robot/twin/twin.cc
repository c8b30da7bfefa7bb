#include "robot/twin/twin.h"

#include <fmt/format.h>

#include <algorithm>
#include <functional>
#include <string>
#include <utility>
#include <vector>

#include "robot/base/worker.h"
#include "robot/twin/outbox.h"
#include "sim/color/color_camera.h"
#include "sim/rays/ray_scene.h"

namespace merlin {
namespace {

// The k-th sampling instant of a rate, on the grid of physics steps.
class Schedule {
 public:
  explicit Schedule(double rate_hz) : rate_hz_(rate_hz), period_s_(1.0 / rate_hz) {}
  double rate_hz() const { return rate_hz_; }
  bool Due(Time now) {
    const Time next = FromSeconds(static_cast<double>(count_) * period_s_);
    if (now < next) return false;
    ++count_;
    return true;
  }

 private:
  double rate_hz_, period_s_;
  std::uint64_t count_ = 0;
};

// The default does not depend on the number of cores: on a single core three threads take no more processor time than
// one.
int ThreadsOf(const TwinOptions& options) { return options.threads > 0 ? options.threads : options.color ? 3 : 2; }

// How many threads share the rows of a depth frame. Two, where the frame is what a run waits for. With a colour camera
// beside a small frame both cores are busy without it.
int DepthThreadsOf(const TwinOptions& options) {
  constexpr int kLarge_px = 10'000;
  const CameraModel& lens = options.depth.sheet.camera;
  return ThreadsOf(options) > 1 && (!options.color || lens.width * lens.height > kLarge_px) ? 2 : 1;
}

class TwinDepth final : public DepthCamera {
 public:
  TwinDepth(const TwinOptions& options, const sim::World& world, Worker& worker)
      : info_{options.depth.sheet, options.world.car.T_base_depth, options.depth.rate_hz},
        camera_(options.depth.sheet, options.depth.errors, options.depth.effects, options.seed,
                DepthThreadsOf(options)),
        surroundings_(sim::SurroundingsOf(world.model(), options.materials)),
        scene_(world.model(), CarBodies(world), sim::PanesOf(surroundings_)),
        worker_(worker),
        schedule_(options.depth.rate_hz),
        outbox_(FromSeconds(options.depth.sheet.latency_s)) {
    Configure(options.depth.settings);
  }
  ~TwinDepth() override {
    worker_.Do([] {}).get();
  }  // running jobs still use this object

  void Sample(const sim::World& world) {
    now_ = world.Now();
    if (!schedule_.Due(now_)) return;
    auto bodies = world.Motions();
    const sim::BodyMotion camera = world.CameraMotion(info_.T_base_camera);
    // A frame is not ready before its last sub-frame is over.
    const Time out = now_ + FromSeconds(std::max(info_.sheet.latency_s, 0.5 * info_.sheet.ExposureSpan_s(settings_)));
    outbox_.Put(
        now_, out,
        worker_.Do([this, bodies = std::move(bodies), camera, settings = settings_, stamp = now_, index = index_++] {
          return camera_.Expose({scene_, surroundings_, bodies, camera}, settings, stamp, index);
        }));
  }

  const DepthCameraInfo& Info() const override { return info_; }
  void Configure(const DepthSettings& settings) override {
    CheckSettings(info_.sheet, settings);
    const double span_s = info_.sheet.ExposureSpan_s(settings);
    if (span_s * info_.rate_hz > 1.0 + 1e-9)
      throw InputError(info_.sheet.name, "the exposure is longer than the time between two frames",
                       fmt::format("at most {:g} ms at {:g} Hz", 1e3 / info_.rate_hz, info_.rate_hz),
                       fmt::format("{:g} ms", 1e3 * span_s));
    settings_ = settings;
  }
  std::optional<DepthFrame> Poll() override { return outbox_.Take(now_); }
  DeviceStatus Status() const override { return WithRate(outbox_.status(), schedule_.rate_hz()); }

 private:
  DepthCameraInfo info_;
  sim::TofCamera camera_;
  sim::Surroundings surroundings_;
  sim::RayScene scene_;  // used by the worker's jobs only
  Worker& worker_;
  Schedule schedule_;
  Outbox<DepthFrame> outbox_;
  DepthSettings settings_;
  Time now_{0};
  std::uint64_t index_ = 0;
};

class TwinColor final : public ColorCamera {
 public:
  TwinColor(const TwinOptions& options, const sim::World& world, Worker& worker)
      : info_{options.color->sheet, options.world.car.T_base_color.value(), options.color->rate_hz},
        worker_(worker),
        schedule_(options.color->rate_hz),
        outbox_(FromSeconds(options.color->sheet.latency_s)) {
    Configure(options.color->settings.value_or(DefaultSettings(info_.sheet)));
    // A GL context belongs to the thread that draws.
    worker_
        .Do([this, model = world.model(), &color = *options.color, seed = options.seed] {
          camera_ = std::make_unique<sim::ColorCamera>(model, color.sheet, color.gl, seed, color.motion_blur);
        })
        .get();
  }
  ~TwinColor() override {
    worker_.Do([this] { camera_.reset(); }).get();
  }

  void Sample(const sim::World& world) {
    now_ = world.Now();
    if (!schedule_.Due(now_)) return;
    auto shot = camera_->Take(world.model(), world.data(), world.CameraMotion(info_.T_base_camera), world.Motions());
    outbox_.Put(now_, worker_.Do([this, shot, settings = settings_, stamp = now_, index = index_++] {
      return camera_->Expose(*shot, settings, stamp, index);
    }));
  }

  const std::string& gl_name() const { return camera_->gl_name(); }
  const ColorCameraInfo& Info() const override { return info_; }
  void Configure(const ColorSettings& settings) override {
    CheckSettings(info_.sheet, settings);
    settings_ = settings;
  }
  std::optional<ColorFrame> Poll() override { return outbox_.Take(now_); }
  DeviceStatus Status() const override { return WithRate(outbox_.status(), schedule_.rate_hz()); }

 private:
  ColorCameraInfo info_;
  ColorSettings settings_;
  std::unique_ptr<sim::ColorCamera> camera_;
  Worker& worker_;
  Schedule schedule_;
  Outbox<ColorFrame> outbox_;
  Time now_{0};
  std::uint64_t index_ = 0;
};

class TwinCompass final : public Compass {
 public:
  explicit TwinCompass(const TwinOptions& options)
      : config_(options.compass->config), seed_(options.seed), schedule_(options.compass->rate_hz) {}

  void Sample(const sim::World& world) {
    now_ = world.Now();
    if (schedule_.Due(now_)) outbox_.Put(now_, sim::ReadCompass(world.T_world_base(), config_, seed_, now_, index_++));
  }
  std::optional<CompassReading> Poll() override { return outbox_.Take(now_); }
  DeviceStatus Status() const override { return WithRate(outbox_.status(), schedule_.rate_hz()); }

 private:
  sim::CompassConfig config_;
  std::uint64_t seed_;
  Schedule schedule_;
  Outbox<CompassReading> outbox_{Duration(0)};
  Time now_{0};
  std::uint64_t index_ = 0;
};

class TwinDrive final : public Drive {
 public:
  TwinDrive(sim::World& world, double rate_hz) : world_(world), schedule_(rate_hz) {}

  void Sample() {
    if (schedule_.Due(world_.Now()))
      outbox_.Put(world_.Now(), world_.drive().Read(world_.model(), world_.data(), world_.Now()));
  }
  void Send(const DriveCommand& command) override { world_.drive().Send(command, world_.Now()); }
  std::optional<DriveState> Poll() override { return outbox_.Take(world_.Now()); }
  DeviceStatus Status() const override { return WithRate(outbox_.status(), schedule_.rate_hz()); }

 private:
  sim::World& world_;
  Schedule schedule_;
  Outbox<DriveState> outbox_{Duration(0)};
};

// The pan unit, or the turntable.
class TwinTurn final : public PanUnit {
 public:
  TwinTurn(const sim::World& world, double rate_hz, std::function<void(double)> send, std::function<double()> read)
      : world_(world), send_(std::move(send)), read_(std::move(read)), schedule_(rate_hz) {}

  void Sample() {
    if (schedule_.Due(world_.Now())) outbox_.Put(world_.Now(), PanState{world_.Now(), read_()});
  }
  void Send(double angle_rad) override { send_(angle_rad); }
  std::optional<PanState> Poll() override { return outbox_.Take(world_.Now()); }
  DeviceStatus Status() const override { return WithRate(outbox_.status(), schedule_.rate_hz()); }

 private:
  const sim::World& world_;
  std::function<void(double)> send_;
  std::function<double()> read_;
  Schedule schedule_;
  Outbox<PanState> outbox_{Duration(0)};
};

// The world's options, with the seed and materials of the whole twin.
sim::WorldOptions WorldOf(const TwinOptions& options) {
  sim::WorldOptions world = options.world;
  world.materials = options.materials;
  world.seed = options.seed;
  return world;
}

}  // namespace

struct Twin::Impl final : public Clock {
  explicit Impl(const TwinOptions& options)
      : end(options.end),
        world(WorldOf(options)),
        depth_worker(ThreadsOf(options) > 1),
        color_worker(ThreadsOf(options) > 2),
        depth(options, world, depth_worker),
        drive(world, options.drive_rate_hz) {
    // With two threads both cameras share the one that is not the caller's.
    if (options.color) color.emplace(options, world, ThreadsOf(options) > 2 ? color_worker : depth_worker);
    if (options.compass) compass.emplace(options);
    if (world.pan() != nullptr)
      pan.emplace(
          world, options.drive_rate_hz, [this](double angle_rad) { world.pan()->Send(angle_rad); },
          [this] { return world.pan()->Read_rad(world.data()); });
    if (world.turntable() != nullptr)
      turntable.emplace(
          world, options.drive_rate_hz, [this](double angle_rad) { world.turntable()->Send(angle_rad); },
          [this] { return world.turntable()->angle_rad(); });
    Sample();
  }

  void Sample() {
    depth.Sample(world);
    if (color) color->Sample(world);
    if (compass) compass->Sample(world);
    drive.Sample();
    if (pan) pan->Sample();
    if (turntable) turntable->Sample();
  }

  Time Now() const override { return world.Now(); }
  bool WaitUntil(Time time) override {
    while (world.Now() < time) {
      if (world.Now() >= end) return false;
      world.Step();
      if (on_step) on_step(world);
      Sample();
    }
    return true;
  }

  Time end;
  sim::World world;
  Worker depth_worker, color_worker;
  TwinDepth depth;
  std::optional<TwinColor> color;
  std::optional<TwinCompass> compass;
  TwinDrive drive;
  std::optional<TwinTurn> pan, turntable;
  std::function<void(sim::World&)> on_step;
  std::string no_gl;
};

std::vector<bool> CarBodies(const sim::World& world) {
  std::vector<bool> bodies(static_cast<std::size_t>(world.model()->nbody), false);
  for (int geom = 0; geom < world.model()->ngeom; ++geom)
    if (world.IsCarGeom(geom)) bodies[static_cast<std::size_t>(world.model()->geom_bodyid[geom])] = true;
  return bodies;
}

Twin::Twin(const TwinOptions& options) : impl_(std::make_unique<Impl>(options)) {}
Twin::~Twin() = default;

Robot Twin::robot() {
  return {.clock = impl_.get(),
          .depth = &impl_->depth,
          .color = impl_->color ? &*impl_->color : nullptr,
          .compass = impl_->compass ? &*impl_->compass : nullptr,
          .drive = &impl_->drive,
          .pan = impl_->pan ? &*impl_->pan : nullptr,
          .turntable = impl_->turntable ? &*impl_->turntable : nullptr};
}
sim::World& Twin::world() { return impl_->world; }
const sim::World& Twin::world() const { return impl_->world; }
const std::string& Twin::gl_name() const { return impl_->color ? impl_->color->gl_name() : impl_->no_gl; }
void Twin::OnStep(std::function<void(sim::World&)> callback) { impl_->on_step = std::move(callback); }

}  // namespace merlin
