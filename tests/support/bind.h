#pragma once

#include "core/material.h"
#include "core/params.h"
#include "core/texture.h"

namespace frond::test {

/// For plugins whose parameters refer to nothing.
class NoLookups final : public ParamResolver {
 public:
  std::shared_ptr<const FloatTexture> float_texture(const std::string&, const Location& w) override { none(w); }
  std::shared_ptr<const SpectrumTexture> spectrum_texture(const std::string&, const Location& w) override { none(w); }
  std::shared_ptr<Material> material(const std::string&, const Location& w) override { none(w); }
  SpectrumPtr spectrum(const ParsedParam& p, SpectrumUse) override { none(p.where); }
  std::filesystem::path file(const std::string&, const Location& w) override { none(w); }

 private:
  [[noreturn]] static void none(const Location& where) { fail(where, "this test resolves nothing"); }
};

inline ParsedParam number(std::string type, std::string name, std::vector<double> values) {
  return {std::move(type), std::move(name), {}, {}, std::move(values)};
}

/// Makes a plugin as a scene file would, from parameters that refer to nothing.
template <class Info, class... Args>
auto make_plugin(const Info& info, std::vector<ParsedParam> params, const Args&... args) {
  NoLookups none;
  return info.make(Params(info, {std::string(info.name), {}, std::move(params)}, none), args...);
}

}  // namespace frond::test
