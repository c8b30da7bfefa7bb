#include "robot/description/mesh_path.h"

#include <fmt/format.h>
#include <tinyxml.h>

#include <algorithm>
#include <cstdlib>
#include <regex>
#include <sstream>
#include <vector>

#include "robot/base/error.h"

namespace merlin {
namespace {

namespace fs = std::filesystem;

struct MeshName {
  std::string package;  // empty: path is no package's
  fs::path path;
};

MeshName Parse(std::string name) {
  std::ranges::replace(name, '\\', '/');
  static const std::regex kUri(R"((?:package|model)://([^/]*)/*(.*))"),
      kFind(R"((?:file:)?/*\$\(find +([^ )]+) *\)/*(.*))");
  std::smatch match;
  if (std::regex_match(name, match, kUri) || std::regex_match(name, match, kFind)) return {match[1], match[2].str()};
  if (name.starts_with("file://")) name = name.substr(7);
  return {"", name};
}

bool IsPackage(const fs::path& folder, const std::string& package) {
  if (folder.filename() == package) return true;
  TiXmlDocument file;
  if (!file.LoadFile((folder / "package.xml").string())) return false;
  const TiXmlElement* root = file.FirstChildElement("package");
  const TiXmlElement* name = root == nullptr ? nullptr : root->FirstChildElement("name");
  const char* text = name == nullptr ? nullptr : name->GetText();
  std::istringstream words(text == nullptr ? "" : text);
  std::string word;
  return words >> word && word == package;
}

std::vector<fs::path> FoldersIn(const fs::path& folder) {
  std::vector<fs::path> folders;
  std::error_code error;
  for (fs::directory_iterator entry(folder, error), end; !error && entry != end; entry.increment(error))
    if (std::error_code unreadable; entry->is_directory(unreadable)) folders.push_back(entry->path());
  std::ranges::sort(folders);  // the system lists them in no fixed order
  return folders;
}

// The package's folders among this one and those up to `levels` below it.
void FindPackage(const fs::path& folder, const std::string& package, int levels, std::vector<fs::path>& found) {
  if (IsPackage(folder, package)) found.push_back(folder);
  if (levels == 0) return;
  for (const fs::path& below : FoldersIn(folder)) FindPackage(below, package, levels - 1, found);
}

// The folders that an environment variable lists, separated by colons.
std::vector<fs::path> Listed(const char* variable) {
  std::vector<fs::path> folders;
  const char* value = std::getenv(variable);
  std::istringstream all(value == nullptr ? "" : value);
  for (std::string folder; std::getline(all, folder, ':');)
    if (!folder.empty()) folders.emplace_back(folder);
  return folders;
}

std::string Setting(const char* variable) {
  const char* value = std::getenv(variable);
  return fmt::format("{} ({})", variable, value == nullptr || *value == '\0' ? "not set" : value);
}

std::vector<fs::path> UpwardsFrom(fs::path folder) {
  std::vector<fs::path> folders{folder};
  for (; folder.has_relative_path(); folders.push_back(folder)) folder = folder.parent_path();
  return folders;
}

// Visits the folders that may belong to the package, until one of them has the file.
class Search {
 public:
  Search(const MeshName& name, std::vector<std::string>& tried) : name_(name), tried_(tried) {}
  bool Has(const fs::path& package) {
    const fs::path file = (package / name_.path).lexically_normal();
    if (std::ranges::find(tried_, file.string()) == tried_.end()) tried_.push_back(file.string());
    std::error_code unreadable;
    if (!fs::is_regular_file(file, unreadable)) return false;
    file_ = file;
    return true;
  }
  bool Among(const fs::path& folder, int levels) {
    std::vector<fs::path> found;
    FindPackage(folder, name_.package, levels, found);
    return std::ranges::any_of(found, [this](const fs::path& package) { return Has(package); });
  }
  const fs::path& file() const { return file_; }

 private:
  const MeshName& name_;
  std::vector<std::string>& tried_;
  fs::path file_;
};

bool FindInPackages(const MeshName& name, const std::vector<fs::path>& above, Search& search) {
  for (const int levels : {0, 1})
    for (const fs::path& folder : above)
      if (search.Among(folder, levels)) return true;
  for (const fs::path& folder : Listed("ROS_PACKAGE_PATH"))
    if (search.Among(folder, 2)) return true;
  for (const fs::path& folder : Listed("AMENT_PREFIX_PATH"))
    if (fs::path share = folder / "share" / name.package; fs::is_directory(share) && search.Has(share)) return true;
  return false;
}

std::string Joined(const std::vector<std::string>& parts) {
  std::string text;
  for (const std::string& part : parts) text += (text.empty() ? "" : ", ") + part;
  return text;
}

}  // namespace

fs::path FindMesh(const fs::path& urdf, const std::string& text, const std::string& where, const std::string& link) {
  const MeshName name = Parse(text);
  const std::vector<fs::path> above = UpwardsFrom(fs::absolute(urdf).lexically_normal().parent_path());
  std::vector<std::string> tried;
  Search search(name, tried);
  if (!name.path.empty()) {
    if (!name.package.empty() && FindInPackages(name, above, search)) return search.file();
    if (search.Has(above[0])) return search.file();
  }
  std::string looked = tried.empty() ? "a file in a package" : "a file " + Joined(tried);
  if (!name.package.empty()) {
    std::vector<std::string> folders;
    for (const fs::path& folder : above) folders.push_back(folder.string());
    looked += fmt::format("; a package '{}' was looked for, by its folder's name and by package.xml, in {}, {} and {}",
                          name.package, Joined(folders), Setting("ROS_PACKAGE_PATH"), Setting("AMENT_PREFIX_PATH"));
  }
  throw InputError(where, fmt::format("link '{}': missing mesh '{}'", link, text), looked);
}

}  // namespace merlin
