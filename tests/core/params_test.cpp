#include "core/params.h"

#include <gmock/gmock.h>

#include "core/plugin.h"
#include "core/texture.h"

namespace frond {
namespace {

using ::testing::ElementsAre;

constexpr std::string_view kModes[] = {"analog", "weighted"};
constexpr Param kParams[] = {
    {.name = "roughness",
     .kind = ParamKind::real,
     .default_value = 0.1,
     .range = {0, 1},
     .doc = "A number without unit."},
    {.name = "thickness",
     .kind = ParamKind::real,
     .default_value = 1e-4,
     .unit = "m",
     .range = {1e-6, 1e-2},
     .doc = "A number with a unit."},
    {.name = "depth", .kind = ParamKind::integer, .default_value = 5, .range = kAtLeastZero, .doc = "An integer."},
    {.name = "twosided", .kind = ParamKind::boolean, .default_value = false, .doc = "A bool."},
    {.name = "mode",
     .kind = ParamKind::string,
     .default_value = std::string_view("analog"),
     .doc = "One of some.",
     .choices = kModes},
    {.name = "reflectance",
     .kind = ParamKind::spectrum_texture,
     .default_value = 0.5,
     .doc = "A number at every wavelength."},
    {.name = "tint",
     .kind = ParamKind::albedo,
     .default_value = std::array<double, 3>{0.1, 0.2, 0.3},
     .doc = "An rgb by default."},
    {.name = "amount", .kind = ParamKind::float_texture, .default_value = 0.25, .range = {0, 1}, .doc = "A texture."},
    {.name = "P", .kind = ParamKind::point3, .doc = "Points.", .list = true},
    {.name = "up", .kind = ParamKind::vector3, .default_value = std::array<double, 3>{0, 0, 1}, .doc = "One vector."},
};
const PluginInfo kInfo{"material", "test", "For tests.", "", kParams};

constexpr Param kNeedy[] = {{.name = "file", .kind = ParamKind::string, .doc = "A file.", .required = true}};
constexpr Param kWhole[] = {
    {.name = "real", .kind = ParamKind::real, .default_value = 0, .doc = "A number."},
    {.name = "texture", .kind = ParamKind::float_texture, .default_value = 2, .doc = "A number."},
    {.name = "none", .kind = ParamKind::real, .doc = "None by default."},
};
const PluginInfo kWholeInfo{"light", "whole", "For tests.", "", kWhole};

const PluginInfo kNeedyInfo{"shape", "needy", "For tests.", "", kNeedy};

/// Records its requests.
class RecordingResolver final : public ParamResolver {
 public:
  std::shared_ptr<const FloatTexture> float_texture(const std::string& name, const Location&) override {
    asked.push_back("float texture " + name);
    return std::make_shared<ConstantFloatTexture>(0.75f);
  }
  std::shared_ptr<const SpectrumTexture> spectrum_texture(const std::string& name, const Location&) override {
    asked.push_back("spectrum texture " + name);
    return nullptr;
  }
  std::shared_ptr<Material> material(const std::string& name, const Location&) override {
    asked.push_back("material " + name);
    return nullptr;
  }
  SpectrumPtr spectrum(const ParsedParam& p, SpectrumUse use) override {
    asked.push_back(p.type + (use == SpectrumUse::illuminant ? " emission " : " ") + p.name);
    given = p;
    return nullptr;
  }
  std::filesystem::path file(const std::string& name, const Location&) override { return "scene/" + name; }

  std::vector<std::string> asked;
  ParsedParam given;
};

/// A place on line `line`: the declaration in column 3, its first value in column 20.
Location at(int line, int column) { return {std::make_shared<const std::string>("a.pbrt"), line, column}; }

ParsedParam parsed(std::string type, std::string name, decltype(ParsedParam::values) values, int line = 2) {
  ParsedParam p;
  p.type = std::move(type), p.name = std::move(name), p.values = std::move(values);
  p.where = at(line, 3), p.value_where = at(line, 20);
  return p;
}

using Numbers = std::vector<double>;
using Words = std::vector<std::string>;

class ParamsTest : public ::testing::Test {
 protected:
  Params make(std::vector<ParsedParam> given, const PluginInfo& info = kInfo) {
    return Params(info, {std::string(info.name), at(1, 1), std::move(given)}, resolver_);
  }
  /// The error's text, or "" where there is none.
  std::string error(std::vector<ParsedParam> given, const PluginInfo& info = kInfo) {
    try {
      make(std::move(given), info);
    } catch (const InputError& e) {
      return e.what();
    }
    return "";
  }
  RecordingResolver resolver_;
};

TEST_F(ParamsTest, DefaultsOfAnAttributeThatAreNotTakenArePassedOver) {
  ParsedParam other_type = parsed("string", "roughness", Words{"t"}), unknown = parsed("float", "roughnes", Numbers{1});
  other_type.may_be_unused = unknown.may_be_unused = true;
  const Params p = make({other_type, unknown});
  EXPECT_FALSE(p.given("roughness"));
  EXPECT_EQ(p.real("roughness"), 0.1);
}

TEST_F(ParamsTest, DefaultsHoldWhereNothingIsGiven) {
  const Params p = make({});
  EXPECT_EQ(p.real("roughness"), 0.1);
  EXPECT_EQ(p.integer("depth"), 5);
  EXPECT_FALSE(p.boolean("twosided"));
  EXPECT_EQ(p.string("mode"), "analog");
  EXPECT_EQ(p.float_texture("amount")->evaluate({}), 0.25f);
  EXPECT_EQ(p.vec3("up"), (Vec3{0, 0, 1}));
  EXPECT_THAT(p.vec3s("P"), ElementsAre());
  EXPECT_FALSE(p.given("roughness"));
}

TEST_F(ParamsTest, GivenValuesReplaceDefaults) {
  const Params p =
      make({parsed("float", "roughness", Numbers{0.3}), parsed("integer", "depth", Numbers{7}),
            parsed("bool", "twosided", std::vector<bool>{true}), parsed("string", "mode", Words{"weighted"}),
            parsed("vector", "up", Numbers{1, 2, 3}), parsed("point", "P", Numbers{0, 1, 2, 3, 4, 5})});
  EXPECT_EQ(p.real("roughness"), 0.3);
  EXPECT_EQ(p.integer("depth"), 7);
  EXPECT_TRUE(p.boolean("twosided"));
  EXPECT_EQ(p.string("mode"), "weighted");
  EXPECT_EQ(p.vec3("up"), (Vec3{1, 2, 3}));
  EXPECT_THAT(p.vec3s("P"), ElementsAre(Vec3{0, 1, 2}, Vec3{3, 4, 5}));
  EXPECT_TRUE(p.given("roughness"));
}

TEST_F(ParamsTest, DefaultOfOneNumberIsASpectrumAndOfThreeAnRgb) {
  const Params p = make({});
  p.spectrum_texture("reflectance");
  EXPECT_EQ(resolver_.given.type, "spectrum");
  EXPECT_THAT(std::get<Numbers>(resolver_.given.values), ElementsAre(360, 0.5, 2500, 0.5));
  p.spectrum("tint");
  EXPECT_EQ(resolver_.given.type, "rgb");
  EXPECT_THAT(std::get<Numbers>(resolver_.given.values), ElementsAre(0.1, 0.2, 0.3));
}

TEST_F(ParamsTest, TexturesAreLookedUpByName) {
  const Params p = make({parsed("texture", "amount", Words{"veins"}), parsed("texture", "reflectance", Words{"leaf"})});
  EXPECT_EQ(p.float_texture("amount")->evaluate({}), 0.75f);
  p.spectrum_texture("reflectance");
  EXPECT_THAT(resolver_.asked, ElementsAre("float texture veins", "spectrum texture leaf"));
}

TEST_F(ParamsTest, FilesAreFoundByTheResolver) {
  EXPECT_EQ(make({parsed("string", "file", Words{"leaf.csv"})}, kNeedyInfo).file("file"), "scene/leaf.csv");
}

TEST_F(ParamsTest, MisspeltNameNamesTheRightOne) {
  EXPECT_EQ(error({parsed("float", "rougness", Numbers{0.1})}),
            "a.pbrt:2:3: material \"test\" has no parameter \"rougness\"; did you mean \"roughness\"?");
}

TEST_F(ParamsTest, UnlikeNameListsWhatThereIs) {
  EXPECT_EQ(error({parsed("float", "colour", Numbers{0.1})}, kNeedyInfo),
            "a.pbrt:2:3: shape \"needy\" has no parameter \"colour\"; there is file");
}

TEST_F(ParamsTest, WrongTypeNamesTheRightOnes) {
  EXPECT_EQ(error({parsed("float", "reflectance", Numbers{0.1})}),
            "a.pbrt:2:3: \"reflectance\" is rgb or spectrum or blackbody or texture, a float was given");
}

TEST_F(ParamsTest, ValueOutsideItsRangeSaysTheRangeAndUnit) {
  EXPECT_EQ(error({parsed("float", "thickness", Numbers{1})}),
            "a.pbrt:2:20: \"thickness\" is 1, outside its range 1e-06 to 0.01 m");
  EXPECT_EQ(error({parsed("float", "roughness", Numbers{-0.5})}),
            "a.pbrt:2:20: \"roughness\" is -0.5, outside its range 0 to 1");
}

TEST_F(ParamsTest, EndsOfTheRangeAreAllowed) {
  EXPECT_EQ(error({parsed("float", "thickness", Numbers{1e-6})}), "");
  EXPECT_EQ(error({parsed("float", "thickness", Numbers{1e-2})}), "");
}

TEST_F(ParamsTest, NumbersThatAreNotFiniteAreRefused) {
  EXPECT_THAT(error({parsed("float", "roughness", Numbers{std::nan("")})}), testing::HasSubstr("a.pbrt:2:20: "));
  EXPECT_THAT(error({parsed("point", "P", Numbers{0, 1, HUGE_VAL})}), testing::HasSubstr("finite"));
}

TEST_F(ParamsTest, FractionIsNoInteger) {
  EXPECT_EQ(error({parsed("integer", "depth", Numbers{2.5})}), "a.pbrt:2:20: \"depth\" is an integer, 2.5 was given");
  EXPECT_NE(error({parsed("integer", "depth", Numbers{1e12})}), "");
}

TEST_F(ParamsTest, OneValueIsNotTwo) {
  EXPECT_EQ(error({parsed("float", "roughness", Numbers{0.1, 0.2})}),
            "a.pbrt:2:20: \"roughness\" takes 1 value, 2 given");
  EXPECT_NE(error({parsed("float", "roughness", Numbers{})}), "");
}

TEST_F(ParamsTest, PointsComeInThrees) {
  EXPECT_EQ(error({parsed("point", "P", Numbers{0, 1, 2, 3})}),
            "a.pbrt:2:20: \"P\" takes values in groups of 3, 4 given");
}

TEST_F(ParamsTest, WordThatIsNoChoiceListsTheChoices) {
  EXPECT_EQ(error({parsed("string", "mode", Words{"exact"})}),
            "a.pbrt:2:20: \"mode\" is one of analog, weighted, \"exact\" was given");
}

TEST_F(ParamsTest, ParameterGivenTwiceIsRefused) {
  EXPECT_EQ(error({parsed("integer", "depth", Numbers{1}, 2), parsed("integer", "depth", Numbers{2}, 3)}),
            "a.pbrt:3:3: parameter \"depth\" is given twice");
}

TEST_F(ParamsTest, MissingRequiredParameterIsNamedAtTheDirective) {
  EXPECT_EQ(error({}, kNeedyInfo), "a.pbrt:1:1: shape \"needy\" needs parameter \"string file\"");
}

TEST_F(ParamsTest, UnreadListsWhatNobodyAskedFor) {
  const Params p = make({});
  p.real("roughness");
  p.given("depth");
  EXPECT_THAT(p.unread(), ElementsAre("thickness", "twosided", "mode", "reflectance", "tint", "amount", "P", "up"));
}

TEST_F(ParamsTest, ReadingAnUndeclaredParameterIsOurMistake) {
  EXPECT_THROW(make({}).real("secret"), std::logic_error);
}

TEST_F(ParamsTest, AWholeNumberIsADefaultOfAReal) {
  RecordingResolver resolver;
  const Params p(kWholeInfo, {"whole", {}, {}}, resolver);
  EXPECT_EQ(p.real("real"), 0);
  EXPECT_EQ(p.float_texture("texture")->evaluate({}), 2);
  EXPECT_FALSE(p.given("none"));
  try {
    p.real("none");
    FAIL() << "it has no value";
  } catch (const std::logic_error& e) {
    EXPECT_STREQ(e.what(),
                 "light \"whole\" reads parameter \"none\", which the scene does not give and which has no default of "
                 "its kind");
  }
}

TEST(Declarations, AreCheckedWhenTheyAreRegistered) {
  const auto problem = [](const std::vector<Param>& params) {
    return declaration_problem({"light", "x", "", "", params});
  };
  using enum ParamKind;
  EXPECT_EQ(declaration_problem(kInfo), "");
  EXPECT_EQ(declaration_problem(kWholeInfo), "");
  EXPECT_EQ(problem({{.name = "a", .kind = real, .doc = ""}, {.name = "a", .kind = boolean, .doc = ""}}),
            "parameter \"a\" is declared twice");
  EXPECT_EQ(problem({{.name = "", .kind = real, .doc = ""}}), "a parameter has no name");
  const auto wrong = [&](ParamKind kind, Default value) {
    return problem({{.name = "a", .kind = kind, .default_value = value, .doc = ""}});
  };
  constexpr std::array<double, 3> kThree{1, 2, 3};
  for (const auto& [kind, value] : std::vector<std::pair<ParamKind, Default>>{{boolean, 1},
                                                                              {integer, 1.5},
                                                                              {real, true},
                                                                              {string, 1},
                                                                              {point3, 1.0},
                                                                              {vector2, std::string_view("x")},
                                                                              {illuminant, false},
                                                                              {unbounded, std::string_view("x")},
                                                                              {float_texture, kThree},
                                                                              {spectrum_texture, true},
                                                                              {material, 1}})
    EXPECT_THAT(wrong(kind, value), ::testing::StartsWith("the default of \"a\" has the wrong type: it takes "))
        << int(kind);
  EXPECT_EQ(problem({{.name = "a", .kind = real, .default_value = 2, .range = {0, 1}, .doc = ""}}),
            "the default of \"a\" is 2, outside its range 0 to 1");
  EXPECT_EQ(wrong(real, INFINITY), "the default of \"a\" is inf: finite numbers are needed");
  EXPECT_EQ(problem({{.name = "a", .kind = albedo, .default_value = kThree, .range = {0, 1}, .doc = ""}}),
            "the default of \"a\" is 2, outside its range 0 to 1");
  EXPECT_EQ(problem({{.name = "a", .kind = real, .range = {1, 0}, .doc = ""}}), "\"a\" has a range from 1 to 0");
  EXPECT_EQ(problem({{.name = "a", .kind = real, .doc = "", .choices = kModes}}),
            "\"a\" has choices, which only strings can have");
  EXPECT_EQ(
      problem({{.name = "a", .kind = string, .default_value = std::string_view("x"), .doc = "", .choices = kModes}}),
      "the default of \"a\" is \"x\", which is none of analog, weighted");
}

TEST_F(ParamsTest, PlaceIsThatOfTheValueOrElseOfTheDirective) {
  const Params p = make({parsed("float", "roughness", Numbers{0.3}, 9)});
  EXPECT_EQ(p.where("roughness").text(), "a.pbrt:9:20: ");
  EXPECT_EQ(p.where("thickness").text(), "a.pbrt:1:1: ");
}

TEST(PluginTable, UnknownNameNamesTheNearestOne) {
  static const PluginInfo kOther{"shape", "sphere", "", "", {}};
  const std::vector<const PluginInfo*> infos{&kNeedyInfo, &kOther};
  PluginTable<PluginInfo> table("shape", infos);
  EXPECT_EQ(&table.get("sphere", {}), &kOther);
  EXPECT_EQ(table.find("cube"), nullptr);
  try {
    table.get("shere", at(4, 7));
    FAIL() << "there is no such shape";
  } catch (const InputError& e) {
    EXPECT_STREQ(e.what(), "a.pbrt:4:7: unknown shape \"shere\"; did you mean \"sphere\"?");
  }
}

constexpr Param kOtherParams[] = {
    {.name = "roughness", .kind = ParamKind::real, .default_value = 0.9, .range = {0, 1}, .doc = "Of the same name."},
    {.name = "amount", .kind = ParamKind::float_texture, .default_value = 0.5, .range = {0, 1}, .doc = "As well."},
    {.name = "mode", .kind = ParamKind::string, .default_value = std::string_view("analog"), .doc = "Its own."},
};
const PluginInfo kOther{"material", "other", "For tests.", "", kOtherParams};

TEST(Params, AreForwardedAsFarAsAnotherPluginHasThem) {
  RecordingResolver resolver;
  const Params p(kInfo,
                 {"test",
                  {},
                  {{"float", "roughness", {}, {}, std::vector<double>{0.3}},
                   {"float", "thickness", {}, {}, std::vector<double>{1e-3}}}},
                 resolver);
  const Params other = p.forwarded(kOther, {{"string", "mode", {}, {}, std::vector<std::string>{"weighted"}}});
  EXPECT_EQ(other.plugin(), "other");
  EXPECT_EQ(other.real("roughness"), 0.3);
  EXPECT_FALSE(other.given("amount"));
  EXPECT_EQ(other.string("mode"), "weighted");
  EXPECT_THAT(p.unread(), ::testing::Not(::testing::Contains("amount")));
  EXPECT_THAT(p.unread(), ::testing::Contains("thickness"));
}

}  // namespace
}  // namespace frond
