// `merlin drive` as users run it.
#include <fcntl.h>
#include <gtest/gtest.h>
#include <stdlib.h>
#include <sys/wait.h>
#include <termios.h>
#include <unistd.h>

#include <array>
#include <filesystem>
#include <fstream>
#include <string>

#include "tests/support/temporary_folder.h"
#include "tests/tools/command.h"

namespace merlin {
namespace {

Outcome Drive(const std::string& arguments, const std::filesystem::path& folder) {
  return Merlin("drive " + arguments, folder, "2>&1 </dev/null");
}

TEST(DriveCli, RefusesWhatItCannotDriveWith) {
  const TemporaryFolder folder;
  std::ofstream(folder.path() / "file") << "no stick";
  const auto expect = [&](const std::string& arguments, int code, const std::string& part) {
    const Outcome outcome = Drive(arguments, folder.path());
    EXPECT_EQ(outcome.code, code) << arguments << "\n" << outcome.said;
    EXPECT_NE(outcome.said.find(part), std::string::npos) << arguments << "\n" << outcome.said;
    EXPECT_FALSE(std::filesystem::exists(folder.path() / "runs")) << arguments;
  };
  expect("", 2, "no terminal");
  expect("--keyboard", 2, "no terminal");
  expect("--joystick none", 3, "none: this joystick cannot be opened");
  expect("--joystick file", 2, "no joystick");
  expect("--joystick /dev/null", 2, "no joystick");
  expect("--joystick file --keyboard", 2, "--keyboard");
  expect("--keyboard --radio 300", 2, "--radio");
  expect("--keyboard --speed nan", 2, "--speed");
  expect("--keyboard --speed 9", 2, "--speed");
  expect("--keyboard --robot moon", 2, "--robot");
  expect("--keyboard --duration -1", 2, "duration_s");
  expect("corridor_lop --keyboard", 2, "corridor_loop");
}

// A person at a terminal: the program runs in a session of its own, and the test types the keys.
class Person {
 public:
  Person(const std::string& arguments, const std::filesystem::path& folder) {
    keyboard_ = posix_openpt(O_RDWR | O_NOCTTY);
    grantpt(keyboard_);
    unlockpt(keyboard_);
    const std::string name = ptsname(keyboard_);
    screen_ = open(name.c_str(), O_RDWR | O_NOCTTY);  // held, so that the terminal outlives the program
    child_ = fork();
    if (child_ != 0) return;
    setsid();
    const int screen = open(name.c_str(), O_RDWR);  // becomes the session's terminal
    for (const int fd : {0, 1, 2}) dup2(screen, fd);
    const std::string command = "cd '" + folder.string() + "' && exec '" MERLIN_BINARY "' drive " + arguments;
    execl("/bin/sh", "sh", "-c", command.c_str(), nullptr);
    _exit(127);
  }
  ~Person() {
    close(screen_);
    close(keyboard_);
  }
  void Type(const std::string& text) const {
    EXPECT_EQ(write(keyboard_, text.data(), text.size()), ssize_t(text.size()));
  }
  // Reads the screen until it shows this text; false if the program ended first.
  bool Sees(const std::string& text) {
    std::array<char, 4096> buffer;
    while (seen.find(text) == std::string::npos) {
      const ssize_t size = read(keyboard_, buffer.data(), buffer.size());
      if (size <= 0) return false;
      seen.append(buffer.data(), static_cast<std::size_t>(size));
    }
    return true;
  }
  int Wait() {
    int status = 0;
    waitpid(child_, &status, 0);
    return WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status);
  }
  bool TerminalIsAsBefore() const {
    termios now{};
    tcgetattr(screen_, &now);
    return (now.c_lflag & ICANON) != 0 && (now.c_lflag & ECHO) != 0;
  }

  std::string seen;

 private:
  int keyboard_ = -1, screen_ = -1;
  pid_t child_ = -1;
};

TEST(DriveCli, DrivesByKeysOverTheRadioAndLeavesTheTerminalAsItWas) {
  const TemporaryFolder folder;
  Person person("corridor_short --keyboard --radio 57600 --gl off", folder.path());
  ASSERT_TRUE(person.Sees("nobody")) << person.seen;
  EXPECT_FALSE(person.TerminalIsAsBefore());
  person.Type("w");
  ASSERT_TRUE(person.Sees("manual")) << person.seen;
  person.Type("q");
  ASSERT_TRUE(person.Sees("files: runs/corridor_short-drive")) << person.seen;
  EXPECT_EQ(person.Wait(), 0) << person.seen;
  EXPECT_TRUE(person.TerminalIsAsBefore());
  EXPECT_TRUE(std::filesystem::exists(folder.path() / "runs/corridor_short-drive/map.png"));
}

TEST(DriveCli, LeavesTheTerminalAsItWasAfterCtrlC) {
  const TemporaryFolder folder;
  Person person("corridor_short --keyboard --gl off", folder.path());
  ASSERT_TRUE(person.Sees("nobody")) << person.seen;
  person.Type("\x03");
  ASSERT_TRUE(person.Sees("files:")) << person.seen;
  EXPECT_EQ(person.Wait(), 130) << person.seen;
  EXPECT_TRUE(person.TerminalIsAsBefore());
}

}  // namespace
}  // namespace merlin
