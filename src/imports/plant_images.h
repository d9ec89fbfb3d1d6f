#pragma once

#include <array>
#include <filesystem>
#include <map>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "core/log.h"
#include "image/image_file.h"
#include "imports/imported_scene.h"

namespace frond {

/// File to write, relative to the folder of the scene.
struct PlantFile {
  std::string path;
  std::vector<unsigned char> bytes;
};

/// Images of a model: decodes them, and makes the files that the scene names.
class PlantImages {
 public:
  /// `model` is the model file; `folders` are further ones with images; `subfolder` is the folder of the files to
  /// write. All references must outlive this object. Throws InputError for a folder that does not exist.
  PlantImages(const std::vector<ImportedImage>& images, const std::filesystem::path& model,
              const std::vector<std::string>& folders, std::string subfolder, const Log& log);

  /// Returns an image's pixels, or nullptr with a warning if there is none that frond can read.
  const ImageFile* pixels(int32_t image);
  /// Returns the path of a file with the model's image unchanged.
  std::string original(int32_t image);
  /// Returns the path of a file with the colours times a factor per channel, 8 bits in sRGB, which is made once.
  std::string tinted_image(int32_t image, const std::array<float, 3>& factor, const std::string& name);
  /// Returns the path of a file with a normal map whose x and y are multiplied, which is made once.
  std::string normal_image(int32_t image, const std::array<float, 2>& scale, const std::string& name);
  /// Returns the path of a new file with one channel, linear.
  std::string write_grey_image(int width, int height, std::vector<float> values, const std::string& name);

  const std::vector<PlantFile>& files() const { return files_; }
  /// Image files that were read.
  const std::vector<std::filesystem::path>& inputs() const { return inputs_; }

 private:
  struct Decoded {
    ImageFile file;
    std::vector<unsigned char> bytes;
    std::string path;  ///< of the file to write, once it is used
  };
  Decoded* decoded(int32_t image);
  /// Returns a path for a file, which no other one has.
  std::string new_path(const std::string& name, const std::string& extension);
  /// Returns where a file that the model names is. Throws InputError if it is in no folder that may be
  /// read.
  std::filesystem::path find_file(std::string name) const;

  const std::vector<ImportedImage>& images_;
  std::filesystem::path model_;
  std::vector<std::filesystem::path> folders_;  ///< further ones, canonical
  std::string subfolder_;
  const Log& log_;
  std::map<int32_t, std::unique_ptr<Decoded>> decoded_;
  std::map<std::pair<int32_t, std::array<float, 3>>, std::string> tinted_;  ///< paths
  std::vector<PlantFile> files_;
  std::vector<std::filesystem::path> inputs_;
};

/// Returns the linear value of an sRGB-encoded one.
float to_linear(float v);

/// Returns a name with only letters, digits, _ and -, which every file system and scene file can hold; not empty.
std::string plain_name(std::string_view name);

}  // namespace frond
