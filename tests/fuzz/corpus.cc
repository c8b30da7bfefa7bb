// Gives libFuzzer the seeds of the target to start with. Without them it would spend its minute on finding out what a
// well-formed header looks like.
#include <filesystem>
#include <fstream>
#include <string>

#include "tests/fuzz/target.h"

// libFuzzer calls this before it reads its arguments. Writes the seeds into a new folder "<program>-corpus" and adds it
// to the arguments, because libFuzzer starts with the files of the folders that it is given.
extern "C" int LLVMFuzzerInitialize(int* argc, char*** argv) {
  static std::string folder = std::filesystem::absolute((*argv)[0]).string() + "-corpus";
  std::filesystem::remove_all(folder);
  std::filesystem::create_directories(folder);
  const std::vector<merlin::Bytes> seeds = merlin::fuzz::Seeds();
  for (std::size_t i = 0; i < seeds.size(); ++i) {
    std::ofstream file(std::filesystem::path(folder) / std::to_string(i), std::ios::binary);
    file.write(reinterpret_cast<const char*>(seeds[i].data()), static_cast<std::streamsize>(seeds[i].size()));
  }
  static std::vector<char*> arguments(*argv, *argv + *argc);
  arguments.push_back(folder.data());
  arguments.push_back(nullptr);
  *argc = static_cast<int>(arguments.size()) - 1;
  *argv = arguments.data();
  return 0;
}
