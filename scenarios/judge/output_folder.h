// The folder a run leaves its files in.
#pragma once

#include <filesystem>
#include <string_view>

namespace merlin {

// Holds one run, and never a mixture of two. A marker file, ".merlin-run", is written before all else and says
// "running" until Finish, then "complete"; result.json comes last. So a folder without result.json is no finished run.
// While the object lives no other run on this machine can take the same folder.
class OutputFolder {
 public:
  static constexpr std::string_view kMarker = ".merlin-run";

  // Throws as the constructor does, and changes nothing: to be asked before the work whose results it is to hold.
  static void Check(const std::filesystem::path& path);

  // Takes the folder: one that does not exist is made, parents too; an empty one is used; one with a marker of ours (a
  // regular file of that name) is emptied whole, result.json first; a link to a folder counts as the folder. Throws
  // InputError, with nothing changed, for any other that is not empty, for what is no folder, for one that cannot be
  // written, and for one in which a run is at work. MachineError when the disk is full.
  explicit OutputFolder(const std::filesystem::path& path);
  ~OutputFolder();
  OutputFolder(const OutputFolder&) = delete;
  OutputFolder& operator=(const OutputFolder&) = delete;

  const std::filesystem::path& path() const { return path_; }

  // Writes a file of the run, whole or not at all. Throws MachineError.
  void Write(std::string_view name, std::string_view bytes) const;

  // Writes result.json and marks the run complete: call it last. Throws MachineError.
  void Finish(std::string_view result_json);

 private:
  std::filesystem::path path_;
  int marker_ = -1;  // file descriptor, locked
};

}  // namespace merlin
