// The JSON of glTF files, which is compared with what the import reads.

#include "imports/gltf_check.h"

#include <stdexcept>

#include "tests/fuzz/fuzz.h"

using namespace frond;

FROND_FUZZ_TARGET(gltf_check, bytes) {
  std::vector<ImportedLoss> losses;
  try {
    losses = check_gltf(bytes);
  } catch (const std::runtime_error& error) {
    fuzz::require(!std::string_view(error.what()).empty(), "a refusal has a message");
    return;
  }
  for (size_t i = 0; i < losses.size(); ++i) {
    fuzz::require(!text_of(losses[i]).empty(), "a loss has a text");
    for (size_t j = 0; j < i; ++j)
      fuzz::require(losses[i].what != losses[j].what || losses[i].materials.empty() != losses[j].materials.empty(),
                    "a loss is named once");
  }
}
