#include "robot/hardware/operator/joystick_device.h"

#include <gtest/gtest.h>

#include <fstream>

#include "robot/base/error.h"
#include "tests/support/joystick_pipe.h"
#include "tests/support/temporary_folder.h"

namespace merlin {
namespace {

TEST(JoystickDevice, RejectsAFileThatIsNotAJoystick) {
  const TemporaryFolder folder;
  EXPECT_THROW(JoystickDevice(folder.path() / "js0"), MachineError);
  std::ofstream(folder.path() / "file") << "not a stick";
  EXPECT_THROW(JoystickDevice(folder.path() / "file"), InputError);
  EXPECT_THROW(JoystickDevice("/dev/null"), InputError);
  EXPECT_THROW(JoystickDevice{folder.path()}, InputError);
}

TEST(JoystickDevice, ReadsWhatCameAndWaitsForNothing) {
  const TemporaryFolder folder;
  JoystickPipe pipe(folder.path() / "js");
  JoystickDevice stick(pipe.path());
  EXPECT_FALSE(stick.Read()) << "nobody is at the other end yet";
  pipe.Open();
  EXPECT_TRUE(stick.Read()) << "held still";
  pipe.Axis(1, -32767);
  pipe.Button(3, true);
  EXPECT_TRUE(stick.Read());
  EXPECT_DOUBLE_EQ(stick.state().axes[1], -1.0);
  EXPECT_TRUE(stick.state().buttons[3]);
  for (int i = 0; i < 500; ++i) pipe.Axis(0, static_cast<std::int16_t>(i));  // more than one read takes
  EXPECT_TRUE(stick.Read());
  EXPECT_NEAR(stick.state().axes[0], 499.0 / 32767.0, 1e-12);
}

TEST(JoystickDevice, SaysWhenTheStickHasGoneAndWhenItIsBack) {
  const TemporaryFolder folder;
  JoystickPipe pipe(folder.path() / "js");
  JoystickDevice stick(pipe.path());
  pipe.Axis(1, 32767);
  EXPECT_TRUE(stick.Read());
  pipe.Axis(1, 1000);
  pipe.Close();
  EXPECT_FALSE(stick.Read());
  EXPECT_FALSE(stick.Read());
  pipe.Axis(1, 0);
  EXPECT_TRUE(stick.Read());
  EXPECT_DOUBLE_EQ(stick.state().axes[1], 0.0);
}

}  // namespace
}  // namespace merlin
