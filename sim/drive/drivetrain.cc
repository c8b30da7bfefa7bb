#include "sim/drive/drivetrain.h"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "robot/kinematics/ackermann.h"
#include "sim/world/spec.h"

namespace merlin::sim::drivetrain {
namespace {

constexpr char kTendon[] = "differential";
constexpr char kServoJoint[] = "virtual_front_wheel_joint";
constexpr char kVirtualWheel[] = "virtual_front_wheel";

// Steering servo: a stiff position loop at the linkage. The values are guesses; with less inertia the front wheels
// shimmy.
constexpr double kServoStiffness_n_m_rad = 20.0;
constexpr double kServoDamping_n_m_s_rad = 0.4;
constexpr double kServoInertia_kg_m2 = 2e-3;

void CheckSpec(const char* error) {
  if (error != nullptr && *error != '\0') throw std::logic_error(std::string("MuJoCo refuses an actuator: ") + error);
}

// The quartic through 0 that best fits FrontWheelAngle_rad over the steering range. MuJoCo's joint equality accepts
// only a quartic.
Eigen::Vector4d AckermannPolynomial(const CarDescription& car, Side side) {
  constexpr int kSamples = 101;
  Eigen::Matrix<double, kSamples, 4> powers;
  Eigen::Matrix<double, kSamples, 1> angles;
  for (int i = 0; i < kSamples; ++i) {
    const double middle_rad = car.steering_max_rad * (2.0 * i / (kSamples - 1) - 1.0);
    powers.row(i) << middle_rad, std::pow(middle_rad, 2), std::pow(middle_rad, 3), std::pow(middle_rad, 4);
    angles[i] = FrontWheelAngle_rad(car, middle_rad, side);
  }
  return powers.colPivHouseholderQr().solve(angles);
}

void AddLinkage(mjSpec* spec, const CarDescription& car, const mjsDefault* plain, std::size_t knuckle, Side side) {
  mjsEquality* equality = mjs_addEquality(spec, plain);
  equality->type = mjEQ_JOINT;
  mjs_setString(equality->name1, car.links[knuckle].joint_name.c_str());
  mjs_setString(equality->name2, kServoJoint);
  equality->data[0] = 0.0;
  Eigen::Vector4d::Map(equality->data + 1) = AckermannPolynomial(car, side);
}

void AddMotor(mjSpec* spec, const CarDescription& car, const mjsDefault* plain) {
  const Drivetrain& d = car.drivetrain;
  // Ideal differentials: the motor turns at the mean speed of the four wheels and drives each with the same torque.
  mjsTendon* tendon = mjs_addTendon(spec, plain);
  SetName(tendon->element, kTendon);
  for (const CarWheel& wheel : car.wheels) mjs_wrapJoint(tendon, car.links[wheel.link].joint_name.c_str(), 0.25);
  mjsActuator* motor = mjs_addActuator(spec, plain);
  SetName(motor->element, kMotor);
  double motor_constant[2] = {d.motor_constant_v_s, d.motor_constant_v_s};
  CheckSpec(mjs_setToDCMotor(motor, motor_constant, d.resistance_ohm, nullptr, nullptr, nullptr, nullptr, nullptr,
                             nullptr, nullptr, mjINPUT_VOLTAGE));
  motor->trntype = mjTRN_TENDON;
  mjs_setString(motor->target, kTendon);
  motor->gear[0] = d.gear;
  motor->ctrllimited = mjLIMITED_TRUE;
  motor->ctrlrange[0] = -d.voltage_max_v, motor->ctrlrange[1] = d.voltage_max_v;
}

// Adds the virtual wheel midway between the front wheels. The servo turns it and the linkage follows its angle. It has
// no shape, and only the minimum mass that MuJoCo requires; its joint carries the servo's inertia.
void AddVirtualWheel(mjSpec* spec, const CarDescription& car, const mjsDefault* plain) {
  mjsBody* body = mjs_addBody(mjs_findBody(spec, car.links[0].name.c_str()), plain);
  SetName(body->element, kVirtualWheel);
  body->pos[0] = car.wheelbase_m;
  body->mass = 1e-12;
  Eigen::Vector3d::Map(body->ipos).setZero();
  Eigen::Vector3d::Map(body->inertia).setConstant(1e-12);
  body->explicitinertial = 1;
  mjsJoint* joint = mjs_addJoint(body, plain);
  SetName(joint->element, kServoJoint);
  joint->type = mjJNT_HINGE;
  joint->axis[0] = 0.0, joint->axis[1] = 0.0, joint->axis[2] = 1.0;
  const double unit = spec->compiler.degree ? 180.0 / std::numbers::pi : 1.0;  // set by the room for the whole spec
  joint->limited = mjLIMITED_TRUE;
  joint->range[0] = -car.steering_max_rad * unit, joint->range[1] = car.steering_max_rad * unit;
  joint->armature = kServoInertia_kg_m2;
}

void AddServo(mjSpec* spec, const CarDescription& car, const mjsDefault* plain) {
  AddVirtualWheel(spec, car, plain);
  mjsActuator* servo = mjs_addActuator(spec, plain);
  SetName(servo->element, kServo);
  double damping[1] = {kServoDamping_n_m_s_rad}, slew[1] = {car.drivetrain.steering_slew_rad_s};
  CheckSpec(mjs_setToPID(servo, kServoStiffness_n_m_rad, damping, nullptr, nullptr, nullptr, slew, 0.0, mjINPUT_POS));
  servo->trntype = mjTRN_JOINT;
  mjs_setString(servo->target, kServoJoint);
  servo->ctrllimited = mjLIMITED_TRUE;
  servo->ctrlrange[0] = -car.steering_max_rad, servo->ctrlrange[1] = car.steering_max_rad;
}

}  // namespace

void AddTo(mjSpec* spec, const CarDescription& car) {
  const BuiltinDefaults plain;
  AddMotor(spec, car, plain.get());
  AddServo(spec, car, plain.get());
  AddLinkage(spec, car, plain.get(), car.knuckles[0], Side::kLeft);
  AddLinkage(spec, car, plain.get(), car.knuckles[1], Side::kRight);
}

}  // namespace merlin::sim::drivetrain
