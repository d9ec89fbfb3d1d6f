#include "system/build_check.h"

#include <gmock/gmock.h>

namespace frond {
namespace {

using testing::AllOf;
using testing::EndsWith;
using testing::HasSubstr;

/// The section as the linker writes it: entries with zeros between them.
std::string problem_of(const std::string& section) {
  return build_mismatch({.headers = section.data(), .headers_end = section.data() + section.size()});
}
std::string entry(const std::string& header, size_t zeros = 1) {
  return header + " " + std::string(own_headers().at(header)) + std::string(zeros, '\0');
}

TEST(BuildCheck, HeadersThatAreTheSameGo) {
  EXPECT_GT(own_headers().size(), 200u);
  EXPECT_EQ(problem_of(entry("core/math/vec.h") + entry("core/light.h", 7) + entry("core/math/vec.h")), "");
}

TEST(BuildCheck, ThoseThatDifferAreNamedOnce) {
  const std::string zero(1, '\0'), other = " 0123456789abcdef" + zero;
  EXPECT_EQ(
      problem_of(entry("core/light.h") + "core/math/vec.h" + other + "core/math/vec.h" + other + "core/gone.h" + other),
      "was compiled from other headers than this frond (core/gone.h, which frond lacks; core/math/vec.h)");
  std::string many;
  for (const char* header :
       {"core/bsdf.h", "core/light.h", "core/film.h", "core/math/ray.h", "core/shape.h", "core/math/vec.h"})
    many += header + other;
  EXPECT_THAT(problem_of(many), EndsWith("core/math/vec.h; and 1 more)"));
  EXPECT_THAT(problem_of("core/math/vec.h" + zero), HasSubstr("(core/math/vec.h)")) << "without a hash";
}

TEST(BuildCheck, NoRecordIsNoPermission) {
  EXPECT_THAT(build_mismatch({.headers = nullptr, .headers_end = nullptr}), HasSubstr("does not say which headers"));
  EXPECT_THAT(build_mismatch({.standard_library = "libc++"}),
              AllOf(HasSubstr("libc++"), EndsWith(FROND_STANDARD_LIBRARY)));
}

}  // namespace
}  // namespace frond
