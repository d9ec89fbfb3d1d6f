#pragma once

#include <functional>
#include <set>
#include <string>
#include <string_view>
#include <vector>

#include "imports/imported_loss.h"

namespace frond {

/// An OBJ file and its material files in a form that the reader library reads correctly: only the statements that it
/// supports, in a syntax that it does not misread. All other statements that change the look are losses.
class ObjText {
 public:
  /// Returns the text of the OBJ file. `is_usable(name)` says whether a material file can be read. Throws
  /// std::runtime_error with the line for invalid vertices and faces.
  std::string model(std::string_view text, const std::function<bool(const std::string&)>& is_usable);
  /// Returns the text of a material file. To be called after `model`.
  std::string materials(std::string_view text);
  /// Returns the losses, of materials that the model uses. To be called after all files have been read.
  std::vector<ImportedLoss> losses() const;

 private:
  LossList losses_;
  std::set<std::string> used_, defined_;  ///< names of materials
};

}  // namespace frond
