#include "sim/world/pan_servo.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <string>

#include "sim/world/spec.h"

namespace merlin::sim {
namespace {

constexpr char kServo[] = "pan_servo";

// Guesses, the same as for the steering servo (sim/drive/drivetrain.cc).
constexpr double kStiffness_n_m_rad = 20.0;
constexpr double kDamping_n_m_s_rad = 0.4;

}  // namespace

void PanServo::AddTo(mjSpec* spec, const CarDescription& car) {
  const BuiltinDefaults plain;
  mjsActuator* servo = mjs_addActuator(spec, plain.get());
  SetName(servo->element, kServo);
  double damping[1] = {kDamping_n_m_s_rad}, slew[1] = {car.pan->slew_rad_s};
  const char* error =
      mjs_setToPID(servo, kStiffness_n_m_rad, damping, nullptr, nullptr, nullptr, slew, 0.0, mjINPUT_POS);
  if (error != nullptr && *error != '\0') throw std::logic_error(std::string("MuJoCo refuses an actuator: ") + error);
  servo->trntype = mjTRN_JOINT;
  mjs_setString(servo->target, car.links[car.pan->link].joint_name.c_str());
}

PanServo::PanServo(const mjModel* model, const CarDescription& car)
    : min_rad_(car.links[car.pan->link].joint_min_rad), max_rad_(car.links[car.pan->link].joint_max_rad) {
  const int servo = mj_name2id(model, mjOBJ_ACTUATOR, kServo);
  if (servo < 0) throw std::logic_error("the model has no pan servo");
  ctrl_ = model->actuator_ctrladr[servo];
  qpos_ = model->jnt_qposadr[model->actuator_trnid[2 * servo]];
}

void PanServo::Send(double angle_rad) {
  if (std::isfinite(angle_rad)) target_rad_ = std::clamp(angle_rad, min_rad_, max_rad_);
}

}  // namespace merlin::sim
