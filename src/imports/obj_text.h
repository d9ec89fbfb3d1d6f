#pragma once

#include <functional>
#include <set>
#include <string>
#include <string_view>
#include <vector>

#include "imports/imported_loss.h"

namespace frond {

/// An OBJ file and its material files as the reader library reads them right: with those statements only that it
/// consumes, in a form that it does not misread. All other statements that change the look are losses.
class ObjText {
 public:
  /// Returns the text of the OBJ file. `is_usable(name)` says whether a material file can be read. Throws
  /// std::runtime_error with the line for vertices and faces that are none.
  std::string model(std::string_view text, const std::function<bool(const std::string&)>& is_usable);
  /// Returns the text of a material file, after that of the OBJ file.
  std::string materials(std::string_view text);
  /// Returns the losses when all files have been read; those of materials that the model uses.
  std::vector<ImportedLoss> losses() const;

 private:
  LossList losses_;
  std::set<std::string> used_, defined_;  ///< names of materials
};

}  // namespace frond
