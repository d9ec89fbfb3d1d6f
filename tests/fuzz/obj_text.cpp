// OBJ and MTL files, separated by a zero byte: the text for the reader library is read again without a change.

#include "imports/obj_text.h"

#include <stdexcept>

#include "tests/fuzz/fuzz.h"

using namespace frond;

FROND_FUZZ_TARGET(obj_text, bytes) {
  const std::string_view model = fuzz::take_part(bytes);
  const auto is_usable = [](const std::string& name) { return name.size() % 2 == 0; };
  const auto no_file = [](const std::string&) { return false; };
  ObjText files;
  std::string text, materials;
  try {
    text = files.model(model, is_usable);
    materials = files.materials(bytes);
  } catch (const std::runtime_error&) {
    return;
  }
  for (const ImportedLoss& loss : files.losses()) fuzz::require(!text_of(loss).empty(), "a loss has a text");
  ObjText again;
  fuzz::require(again.model(text, no_file) == text, "a text in the library's form stays");
  fuzz::require(again.materials(materials) == materials, "materials in the library's form stay");
}
