// The folder into which a run writes its files.
#pragma once

#include <filesystem>
#include <string_view>

namespace merlin {

// Holds the files of one run, never a mixture of two. A marker file, ".merlin-run", is written first; it says "running"
// until Finish and "complete" afterwards. result.json is written last, so a folder without it is not a finished run.
// While the object exists, no other run on this machine can use the same folder.
class OutputFolder {
 public:
  static constexpr std::string_view kMarker = ".merlin-run";

  // Throws like the constructor but changes nothing. For a check before the work whose results the folder is to hold.
  static void Check(const std::filesystem::path& path);

  // Takes the folder. One that does not exist is created together with its parents. An empty one is used. One with our
  // marker (a regular file) is emptied, result.json first. A link to a folder counts as the folder. Throws InputError,
  // and changes nothing, if the folder has other files, is not a folder, is not writable, or is in use by another run.
  // Throws MachineError if the disk is full.
  explicit OutputFolder(const std::filesystem::path& path);
  ~OutputFolder();
  OutputFolder(const OutputFolder&) = delete;
  OutputFolder& operator=(const OutputFolder&) = delete;

  const std::filesystem::path& path() const { return path_; }

  // Writes a file of the run, completely or not at all. Throws MachineError.
  void Write(std::string_view name, std::string_view bytes) const;

  // Writes result.json and marks the run complete: call it last. Throws MachineError.
  void Finish(std::string_view result_json);

 private:
  std::filesystem::path path_;
  int marker_ = -1;  // file descriptor, locked
};

}  // namespace merlin
