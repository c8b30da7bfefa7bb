#include "sim/drivetrain.h"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <numbers>
#include <stdexcept>

#include "sim/spec.h"

namespace merlin::sim::drivetrain {
namespace {

constexpr char kTendon[] = "differential";
constexpr char kMotor[] = "motor";
constexpr char kServo[] = "steering_servo";
constexpr char kServoJoint[] = "virtual_front_wheel_joint";
constexpr char kVirtualWheel[] = "virtual_front_wheel";

// Steering servo: a stiff position loop at the linkage. Guesses; with less rotor inertia the front wheels shimmy.
constexpr double kServoStiffness_n_m_rad = 20.0;
constexpr double kServoDamping_n_m_s_rad = 0.4;
constexpr double kServoInertia_kg_m2 = 2e-3;

// Speed loop: closed-loop bandwidth and integral action, guesses that settle in 0.1 s without overshoot.
constexpr double kSpeedBandwidth_rad_s = 30.0;
constexpr double kSpeedIntegral_rad_s = 5.0;
// When a command has expired. The drive's contract asks for 2 m/s2 after at most 0.2 s; the rest is margin.
constexpr double kBraking_m_s2 = 2.5;

void CheckSpec(const char* error) {
  if (error != nullptr && *error != '\0') throw std::logic_error(std::string("MuJoCo refuses an actuator: ") + error);
}

// Ackermann: both front wheels aim at the centre of the circle of the virtual middle one, on the rear axle's line.
// side is +1 for the left wheel.
double WheelAngle_rad(const CarDescription& car, double middle_rad, double side) {
  const double tangent = std::tan(middle_rad);
  return std::atan2(car.wheelbase_m * tangent, car.wheelbase_m - side * 0.5 * car.steering_track_m * tangent);
}

// The quartic through 0 that fits WheelAngle best over the steering range; MuJoCo's joint equality takes no other law.
Eigen::Vector4d AckermannPolynomial(const CarDescription& car, double side) {
  constexpr int kSamples = 101;
  Eigen::Matrix<double, kSamples, 4> powers;
  Eigen::Matrix<double, kSamples, 1> angles;
  for (int i = 0; i < kSamples; ++i) {
    const double middle_rad = car.steering_max_rad * (2.0 * i / (kSamples - 1) - 1.0);
    powers.row(i) << middle_rad, std::pow(middle_rad, 2), std::pow(middle_rad, 3), std::pow(middle_rad, 4);
    angles[i] = WheelAngle_rad(car, middle_rad, side);
  }
  return powers.colPivHouseholderQr().solve(angles);
}

void AddLinkage(mjSpec* spec, const CarDescription& car, const mjsDefault* plain, std::size_t knuckle, double side) {
  mjsEquality* equality = mjs_addEquality(spec, plain);
  equality->type = mjEQ_JOINT;
  mjs_setString(equality->name1, car.links[knuckle].joint_name.c_str());
  mjs_setString(equality->name2, kServoJoint);
  equality->data[0] = 0.0;
  Eigen::Vector4d::Map(equality->data + 1) = AckermannPolynomial(car, side);
}

void AddMotor(mjSpec* spec, const CarDescription& car, const mjsDefault* plain) {
  const Drivetrain& d = car.drivetrain;
  // Ideal differentials: the motor turns with the mean of the four wheels and shares its torque equally.
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

// The virtual wheel midway between the front ones, which the servo turns and whose angle the linkage follows: a body
// that nobody sees or feels. MuJoCo wants some mass of it; its inertia is the servo's.
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
  const double unit = spec->compiler.degree ? 180.0 / std::numbers::pi : 1.0;  // the room's choice rules the whole spec
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

// What the motor shaft sees of the car: its mass at the wheel's radius, the wheels and the rotor.
double ShaftInertia_kg_m2(const CarDescription& car) {
  double mass_kg = 0.0, wheels_kg_m2 = 0.0;
  for (const CarLink& link : car.links) mass_kg += link.mass_kg;
  for (const CarWheel& wheel : car.wheels) {
    const CarLink& link = car.links[wheel.link];
    const Eigen::Vector3d axis = link.T_link_inertial.linear().transpose() * link.axis;
    wheels_kg_m2 += axis.dot(link.inertia_kg_m2 * axis);
  }
  const double gear2 = car.drivetrain.gear * car.drivetrain.gear;
  return car.drivetrain.rotor_inertia_kg_m2 +
         (mass_kg * car.wheel_radius_m * car.wheel_radius_m + wheels_kg_m2) / gear2;
}

// In a turn the front wheels run on larger circles than the rear axle's middle: the mean path of the four wheels over
// its.
double WheelMeanRatio(const CarDescription& car, double steering_rad) {
  const double tangent = std::tan(steering_rad);
  const double lateral = 0.5 * car.track_m / car.wheelbase_m * tangent;
  return 0.5 + 0.25 * (std::hypot(1.0 - lateral, tangent) + std::hypot(1.0 + lateral, tangent));
}

double Toward(double from, double to, double step) { return from + std::clamp(to - from, -step, step); }

}  // namespace

void AddTo(mjSpec* spec, const CarDescription& car) {
  const BuiltinDefaults plain;
  AddMotor(spec, car, plain.get());
  AddServo(spec, car, plain.get());
  AddLinkage(spec, car, plain.get(), car.knuckles[0], +1.0);
  AddLinkage(spec, car, plain.get(), car.knuckles[1], -1.0);
}

Controller::Controller(const mjModel* model, const CarDescription& car)
    : car_(car), shaft_inertia_kg_m2_(ShaftInertia_kg_m2(car)) {
  const int motor = mj_name2id(model, mjOBJ_ACTUATOR, kMotor), servo = mj_name2id(model, mjOBJ_ACTUATOR, kServo);
  const int joint = mj_name2id(model, mjOBJ_JOINT, kServoJoint);
  if (motor < 0 || servo < 0 || joint < 0) throw std::logic_error("the model has no drivetrain");
  motor_ctrl_ = model->actuator_ctrladr[motor];
  motor_output_ = model->actuator_outadr[motor];
  servo_ctrl_ = model->actuator_ctrladr[servo];
  steering_qpos_ = model->jnt_qposadr[joint];
}

void Controller::Send(const DriveCommand& command, Time now) {
  if (!std::isfinite(command.speed_m_s) || !std::isfinite(command.steering_rad)) {
    expires_ = now;
    return;
  }
  command_ = command;
  command_.speed_m_s = std::clamp(command.speed_m_s, -car_.drivetrain.speed_max_m_s, car_.drivetrain.speed_max_m_s);
  command_.steering_rad = std::clamp(command.steering_rad, -car_.steering_max_rad, car_.steering_max_rad);
  expires_ = command.valid_for > Time::max() - now ? Time::max() : now + std::max(command.valid_for, Duration(0));
}

void Controller::Apply(const mjModel* model, mjData* data, Time now) {
  const Drivetrain& d = car_.drivetrain;
  const bool expired = now >= expires_;
  const double step_s = model->opt.timestep;
  const double acceleration_m_s2 = expired ? std::max(kBraking_m_s2, d.acceleration_max_m_s2) : d.acceleration_max_m_s2;
  const double before_m_s = speed_setpoint_m_s_;
  speed_setpoint_m_s_ = Toward(before_m_s, expired ? 0.0 : command_.speed_m_s, acceleration_m_s2 * step_s);

  // From the rear axle's middle to the motor shaft, which turns with the mean of the four wheels.
  const double shaft_rad_m = d.gear * WheelMeanRatio(car_, data->qpos[steering_qpos_]) / car_.wheel_radius_m;
  const double target_rad_s = speed_setpoint_m_s_ * shaft_rad_m;
  const double error_rad_s = target_rad_s - data->actuator_velocity[motor_output_];
  // V = K w + R/K (torque): the speed's back-EMF, the set point's acceleration, and PI on the error. The shaft's speed
  // is taken as exact: at its rate the count's rounding averages out within a few milliseconds.
  const double volt_per_rad_s2 = d.resistance_ohm / d.motor_constant_v_s * shaft_inertia_kg_m2_;
  const double gain_v_s = volt_per_rad_s2 * kSpeedBandwidth_rad_s;
  const double feed_v =
      d.motor_constant_v_s * target_rad_s + volt_per_rad_s2 * (speed_setpoint_m_s_ - before_m_s) / step_s * shaft_rad_m;
  const double unlimited_v = feed_v + gain_v_s * error_rad_s + integral_v_;
  const double voltage_v = std::clamp(unlimited_v, -d.voltage_max_v, d.voltage_max_v);
  if (voltage_v == unlimited_v) integral_v_ += gain_v_s * kSpeedIntegral_rad_s * error_rad_s * step_s;  // no wind-up

  data->ctrl[motor_ctrl_] = voltage_v;
  data->ctrl[servo_ctrl_] = command_.steering_rad;  // an expired command leaves the wheels where they are
}

DriveState Controller::Read(const mjModel*, const mjData* data, Time now) const {
  const Drivetrain& d = car_.drivetrain;
  const double turns = data->actuator_length[motor_output_] / (2.0 * std::numbers::pi);
  DriveState state;
  state.stamp = now;
  state.encoder_counts = std::llround(turns * d.encoder_counts_per_motor_turn);
  state.steering_rad = data->qpos[steering_qpos_];
  state.current_a =
      (data->ctrl[motor_ctrl_] - d.motor_constant_v_s * data->actuator_velocity[motor_output_]) / d.resistance_ohm;
  state.battery_v = d.voltage_max_v;
  state.expired = now >= expires_;
  return state;
}

}  // namespace merlin::sim::drivetrain
