// What the fuzzing programs of the scene importers share.
#pragma once

#include <map>
#include <optional>

#include "scenes/importers/importer.h"
#include "scenes/scene_file.h"
#include "tests/fuzz/fuzz.h"

namespace framesim::fuzz {

// An input is a document, then the files beside it, each after a line "==== NAME".
class FilesBehind final : public FilesBeside {
 public:
  explicit FilesBehind(std::string_view input) {
    constexpr std::string_view kMark = "\n==== ";
    std::size_t begin = input.find(kMark);
    document_ = input.substr(0, begin);
    while (begin != std::string_view::npos) {
      input.remove_prefix(begin + kMark.size());
      begin = input.find(kMark);
      const std::string_view file = input.substr(0, begin);
      const std::size_t end = file.find('\n');
      if (end != std::string_view::npos) files_.try_emplace(std::string(file.substr(0, end)), file.substr(end + 1));
    }
  }

  std::string_view document() const { return document_; }
  std::optional<std::string> read(const std::string& uri, const std::function<void(std::string)>& refuse) override {
    const auto path = path_of_uri(uri);
    if (!path) refuse("outside");
    const auto found = files_.find(*path);
    if (found == files_.end()) return std::nullopt;
    return std::string(found->second);
  }

 private:
  std::string_view document_;
  std::map<std::string, std::string_view, std::less<>> files_;
};

// Imports the input. What is written for an accepted one is a scene file that the program itself accepts.
inline void import_input(std::string_view input, ImportScene import) {
  FilesBehind files(input);
  ImportedScene scene;
  if (!accepts([&] { scene = import(files.document(), "fuzz", files); })) return;
  require(!describe(scene).empty(), "a description");
  require(scene.instances.size() <= input.size(), "instances within the input's size");
  SceneFiles written;
  if (!accepts([&] { written = write_scene(scene, "fuzz"); })) return;
  const std::string folder =
      std::filesystem::path(as_file(written.instances, written.instances_name.c_str())).parent_path();
  if (!written.camera.empty()) as_file(written.camera, written.camera_name.c_str());
  parse_scene(written.scene, folder + "/fuzz.toml", folder);  // a refusal ends the program
}

}  // namespace framesim::fuzz
