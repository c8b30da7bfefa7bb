// What a port says that cannot be had. The ports are pseudo-terminals.
#include "robot/hardware/serial/serial_port.h"

#include <gtest/gtest.h>
#include <unistd.h>

#include "robot/base/error.h"
#include "robot/emulated/pseudo_terminal.h"

namespace merlin {
namespace {

// Opens the port; what it says, or "".
std::string Complaint(const std::string& port, int baud = 9600) {
  try {
    SerialPort(SerialConfig{.port = port, .baud = baud}).Open();
  } catch (const std::exception& error) {
    return error.what();
  }
  return "";
}

TEST(SerialPort, NamesAPortThatIsNotThere) {
  EXPECT_EQ(Complaint("/dev/no_such_port"),
            "serial port /dev/no_such_port: there is no such port; is the device plugged in?");
}

TEST(SerialPort, NamesWhatIsNoSerialPort) {
  for (const std::string path : {"/dev/null", "/tmp"})
    EXPECT_EQ(Complaint(path), "serial port " + path + ": this is not a serial port");
}

TEST(SerialPort, NamesAPortThatBelongsToAnother) {
  PseudoTerminal terminal;
  const std::string port = terminal.path();
  SerialPort first({.port = port, .baud = 9600});
  first.Open();
  EXPECT_EQ(Complaint(port), "serial port " + port + ": it belongs to another program");
}

TEST(SerialPort, IsFreeAgainOnceItsOwnerIsDone) {
  PseudoTerminal terminal;
  EXPECT_EQ(Complaint(terminal.path()), "");
  EXPECT_EQ(Complaint(terminal.path()), "");
}

TEST(SerialPort, RefusesOtherBaudRates) {
  EXPECT_EQ(Complaint("/dev/null", 300),
            "/dev/null: invalid baud rate; expected 9600, 19200, 57600 or 115200, got 300");
  PseudoTerminal terminal;
  for (const int baud : {9600, 19200, 57600, 115200}) {
    EXPECT_EQ(Complaint(terminal.path(), baud), "");
    EXPECT_EQ(terminal.baud(), baud);
  }
}

TEST(SerialPort, CarriesEveryByteAsItIs) {
  PseudoTerminal terminal;
  SerialPort port({.port = terminal.path(), .baud = 115200});
  port.Open();
  Bytes all(256);
  for (std::size_t i = 0; i < all.size(); ++i) all[i] = static_cast<std::uint8_t>(i);
  EXPECT_TRUE(port.Read().empty());
  EXPECT_TRUE(port.is_open());  // nothing there is not unplugged
  terminal.Write(all);
  Bytes read;
  while (read.size() < all.size()) {
    port.Wait(std::chrono::seconds(10));
    const Bytes more = port.Read();
    ASSERT_FALSE(more.empty());
    read.insert(read.end(), more.begin(), more.end());
  }
  EXPECT_EQ(read, all);
  port.Write(all);
  EXPECT_EQ(terminal.Read(), all);
}

TEST(SerialPort, NoticesTheUnplugAndOpensAgain) {
  const std::filesystem::path link =
      std::filesystem::path(testing::TempDir()) / ("merlin_serial_" + std::to_string(getpid()));
  PseudoTerminal terminal(link);
  SerialPort port({.port = link, .baud = 9600});
  port.Open();
  terminal.Close();
  EXPECT_TRUE(port.Read().empty());
  EXPECT_FALSE(port.is_open());
  port.Write(Bytes{1});  // harmless
  EXPECT_NE(Complaint(link).find("there is no such port"), std::string::npos);
  terminal.Open();
  port.Open();
  EXPECT_TRUE(port.is_open());
}

TEST(SerialPort, WakesFromItsWait) {
  SerialPort port({.port = "/dev/null", .baud = 9600});
  port.Wake();
  port.Wait(std::chrono::hours(1));  // returns at once
}

}  // namespace
}  // namespace merlin
