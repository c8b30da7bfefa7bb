// Serial ports, among them ones that cannot be opened. The ports are pseudo-terminals.
#include "robot/hardware/serial/serial_port.h"

#include <gtest/gtest.h>
#include <unistd.h>

#include <algorithm>
#include <functional>

#include "robot/base/error.h"
#include "robot/emulated/pseudo_terminal.h"
#include "tests/support/until.h"

namespace merlin {
namespace {

// Opens the port and returns the error message, or "".
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

TEST(SerialPort, WakesFromItsWaitOnceForEachWake) {
  SerialPort port({.port = "/dev/null", .baud = 9600});
  EXPECT_FALSE(port.Wait(Duration(0)));
  port.Wake();
  EXPECT_TRUE(port.Wait(std::chrono::hours(1)));
  EXPECT_FALSE(port.Wait(Duration(0)));
}

// Nobody reads until the line is full and has taken a part of a message. The reader must still find whole messages, in
// order; those that came while the tail waited are left out.
TEST(SerialPort, SendsTheTailOfAShortWriteBeforeTheNextMessage) {
  constexpr std::size_t kMessage_bytes = 1000;  // divides no buffer's size
  constexpr std::uint8_t kSent = 200, kLast = 255;
  PseudoTerminal terminal;
  SerialPort port({.port = terminal.path(), .baud = 115200});
  port.Open();
  for (std::uint8_t number = 0; number < kSent; ++number) port.Write(Bytes(kMessage_bytes, number));
  Bytes read;
  ASSERT_TRUE(Until([&] {
    const Bytes more = terminal.Read();
    read.insert(read.end(), more.begin(), more.end());
    port.Write(Bytes(kMessage_bytes, kLast));
    return read.size() >= kMessage_bytes && std::ranges::count(read, kLast) >= 1;
  }));
  std::vector<int> numbers;
  for (std::size_t at = 0; at + kMessage_bytes <= read.size(); at += kMessage_bytes) {
    const BytesView message = BytesView(read).subspan(at, kMessage_bytes);
    numbers.push_back(message.front());
    ASSERT_EQ(std::ranges::count(message, message.front()), static_cast<std::ptrdiff_t>(kMessage_bytes))
        << "message " << numbers.size() << " is a mixture";
  }
  std::erase(numbers, int{kLast});
  ASSERT_LT(numbers.size(), std::size_t{kSent}) << "the line was never full";
  EXPECT_EQ(std::ranges::adjacent_find(numbers, std::greater_equal{}), numbers.end()) << "out of order, or twice";
}

TEST(SerialPort, ForgetsTheTailWhenItIsOpenedAnew) {
  const std::filesystem::path link =
      std::filesystem::path(testing::TempDir()) / ("merlin_serial_tail_" + std::to_string(getpid()));
  PseudoTerminal terminal(link);
  SerialPort port({.port = link, .baud = 115200});
  port.Open();
  for (int i = 0; i < 200; ++i) port.Write(Bytes(1000, 1));
  terminal.Open();  // unplugged and plugged in
  port.Open();
  port.Write(Bytes{7});
  Bytes read;
  ASSERT_TRUE(Until([&] { return !(read = terminal.Read()).empty(); }));
  EXPECT_EQ(read, Bytes{7});
}

}  // namespace
}  // namespace merlin
