// OBJ and MTL files, separated by a zero byte.

#include "models/obj_reader.h"

#include "tests/fuzz/model_reader.h"

using namespace frond;

FROND_FUZZ_TARGET(obj_reader, bytes) {
  const std::string_view model = fuzz::take_part(bytes);
  fuzz::OneFile files(bytes);
  fuzz::check_model([&] { return read_obj(model, "model.obj", files); });
}
