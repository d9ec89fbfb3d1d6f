// glTF files, whose buffers are the file itself.

#include "models/gltf_reader.h"

#include "tests/fuzz/model_reader.h"

using namespace frond;

FROND_FUZZ_TARGET(gltf_reader, bytes) {
  fuzz::OneFile files(bytes);
  fuzz::check_model([&] { return read_gltf(bytes, files); });
}
