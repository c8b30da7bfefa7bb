#include "robot/emulated/pseudo_terminal.h"

#include <fcntl.h>
#include <gtest/gtest.h>
#include <sys/ioctl.h>
#include <termios.h>
#include <unistd.h>

namespace merlin {
namespace {

// Whether somebody has claimed the port for himself.
bool Claimed(const PseudoTerminal& terminal) {
  const int port = open(terminal.path().c_str(), O_RDWR | O_NOCTTY | O_NONBLOCK);
  int claimed = 0;
  EXPECT_EQ(ioctl(port, TIOCGEXCL, &claimed), 0);
  close(port);
  return claimed != 0;
}

TEST(PseudoTerminal, IsFreeAgainAfterAProgramThatDiedWithItsClaim) {
  PseudoTerminal terminal;
  const int port = open(terminal.path().c_str(), O_RDWR | O_NOCTTY | O_NONBLOCK);
  ASSERT_EQ(ioctl(port, TIOCEXCL), 0);
  if (geteuid() != 0) {
    EXPECT_LT(open(terminal.path().c_str(), O_RDWR | O_NOCTTY), 0);
  }
  close(port);  // as the system does for a program that is killed: the claim stays
  if (geteuid() == 0) {
    EXPECT_TRUE(Claimed(terminal));  // nobody else may open the port to ask
  }
  terminal.Unclaim();
  EXPECT_FALSE(Claimed(terminal));
  terminal.Close();
  terminal.Unclaim();  // of a port that is unplugged: nothing
}

}  // namespace
}  // namespace merlin
