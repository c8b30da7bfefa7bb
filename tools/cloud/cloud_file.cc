#include "tools/cloud/cloud_file.h"

#include <algorithm>
#include <cctype>
#include <fstream>
#include <iterator>
#include <system_error>

#include "robot/base/error.h"

namespace merlin {

CloudFile ReadCloud(const std::filesystem::path& file) {
  std::string ending = file.extension().string();
  std::ranges::transform(ending, ending.begin(), [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  constexpr std::array kTexts{".csv", ".txt", ".xyz", ".asc", ".pts"};
  const bool text = std::ranges::find(kTexts, ending) != kTexts.end();
  const auto parse = ending == ".ply" ? ParsePly : ending == ".pcd" ? ParsePcd : text ? ParseCsv : nullptr;
  if (parse == nullptr)
    throw InputError(file.string(), "not a cloud by its name", "a .ply, .pcd, .csv, .txt, .xyz, .asc or .pts");
  std::error_code ignored;
  if (std::filesystem::is_directory(file, ignored)) throw InputError(file.string(), "a folder", "a file");
  std::ifstream in(file, std::ios::binary);
  if (!in) throw InputError(file.string(), "cannot be read: no such file, or no permission");
  const std::string bytes(std::istreambuf_iterator<char>(in), {});
  return parse(bytes, file.string());
}

}  // namespace merlin
