#include "tests/stability/cases.h"
#include "tests/stability/specimen.h"
#include "tests/support/input_error.h"

namespace frond::stability {
namespace {

using leaf::Shares;
using test::flag;
using test::words;

constexpr std::string_view kTableHead = "theta_deg,wavelength_nm,Rs,Rd,T\n";

class Files {
 public:
  explicit Files(Theme& theme) : theme_(theme) {}

  void refuses(std::string name, std::string_view rows, const std::string& part, double nm = 551) {
    refuses_text(std::move(name), std::string(kTableHead) + std::string(rows), part, nm);
  }
  void refuses_text(std::string name, std::string_view text, const std::string& part, double nm = 551) {
    refuses_file(std::move(name), folder_.write("t.csv", text).string(), part, nm);
  }
  void refuses_file(std::string name, const std::string& file, const std::string& part, double nm = 551) {
    theme_.add(std::move(name), expect_refusal(part))
        .add(Method::table_file, refusal(
                                     part, [&] { open(file, nm); }, folder_.name_of("")));
  }

  /// Adds a case of an accepted file whose shares at the angles of `lit` must equal `lit`.
  void holds(std::string name, std::string expected, std::string_view rows, const Lit& lit, double nm = 551) {
    Comparison comparison(2e-4);
    const std::string file = folder_.write("t.csv", std::string(kTableHead) + std::string(rows)).string();
    try {
      Specimen specimen = open(file, nm);
      for (size_t i = 0; i < lit.theta_deg.size(); ++i)
        add_shares(comparison, read_off(specimen.bsdf(), toward_in_float(lit.theta_deg[i])), lit.truth[i]);
    } catch (const InputError& error) {
      comparison.require(false, error.what());
    }
    theme_.add(std::move(name), std::move(expected)).add(Method::table_file, comparison.cell());
  }

  std::string folder() const { return folder_.write("folder/file", "").parent_path().string(); }
  std::string name_of(const std::string& file) const { return folder_.name_of(file); }

 private:
  static Specimen open(const std::string& file, double nm) {
    return Specimen("leaf_simplified", {words("tablefile", {file}), flag("surfacedirect", false)}, nm);
  }

  Theme& theme_;
  TestFolder folder_{"stability"};
};

void add_accepted(Files& files) {
  const Shares s{0.04, 0.06, 0.12};
  files.holds("one row", "holds for all angles, both sides and all wavelengths", "8,551,0.04,0.06,0.12\n",
              {{0, 8, 45, 89.999, 91, 180}, {s, s, s, s, s, s}}, 800);
  files.holds("only angles up to 40 degrees", "values of the nearest angle beyond; both sides equal; within 2e-4",
              "0,551,0.1,0.2,0.3\n40,551,0.04,0.06,0.12\n",
              {{0, 40, 80, 90.1, 140, 180}, {{0.1, 0.2, 0.3}, s, s, s, s, {0.1, 0.2, 0.3}}});
  files.holds("R + T = 1", "accepted unchanged", "8,551,0.1,0.4,0.5\n", {{8, 100}, {{0.1, 0.4, 0.5}, {0.1, 0.4, 0.5}}});
  files.holds("a black leaf: all shares 0", "accepted unchanged: no light is scattered", "8,551,0,0,0\n",
              {{8, 100}, {Shares{}, Shares{}}});
}

void add_bad_numbers(Files& files) {
  files.refuses("R + T = 1.1", "8,551,0.1,0.5,0.5\n", "Rs + Rd + T is 1.1: a leaf scatters 1 at most");
  files.refuses("R + T = 1.00001", "8,551,0.1,0.4,0.50001\n", "a leaf scatters 1 at most");
  files.refuses("NaN", "8,551,0.1,nan,0.5\n", "Rd is a share of the light, from 0 to 1; nan was given");
  files.refuses("infinite", "8,551,0.1,inf,0.5\n", "Rd is a share of the light, from 0 to 1; inf was given");
  files.refuses("negative", "8,551,0.1,-0.1,0.5\n", "Rd is a share of the light, from 0 to 1; -0.1 was given");
  files.refuses("an angle of -1", "-1,551,0.1,0.1,0.5\n", "theta_deg is from 0 to 180, -1 was given");
  files.refuses("an angle of NaN", "nan,551,0.1,0.1,0.5\n", "theta_deg is from 0 to 180, nan was given");
  files.refuses("an angle of 180.1", "180.1,551,0.1,0.1,0.5\n", "theta_deg is from 0 to 180, 180.1 was given");
  files.refuses("a wavelength of 0", "8,0,0.1,0.1,0.5\n", "wavelength_nm is above 0, 0 was given");
  files.refuses("a word instead of a number", "8,551,0.1,much,0.5\n", "Rd is a number, \"much\" was given");
}

void add_bad_order(Files& files) {
  files.refuses("unsorted angles", "40,551,0.1,0.1,0.1\n8,551,0.1,0.1,0.1\n",
                "theta_deg 8 comes after 40 at 551 nm (line 2)");
  files.refuses("a repeated angle", "8,551,0.1,0.1,0.1\n8,551,0.1,0.1,0.1\n",
                "angles ascend, each once for a wavelength");
  files.refuses("an angle missing at one wavelength", "8,551,0.1,0.1,0.1\n40,551,0.1,0.1,0.1\n8,608,0.1,0.1,0.1\n",
                "608 nm has no row for theta_deg 40");
  files.refuses("no angles of the adaxial side", "100,551,0.1,0.1,0.1\n", "those of the adaxial side are missing");
  files.refuses("a wavelength outside the table", "8,551,0.1,0.1,0.1\n8,608,0.1,0.1,0.1\n", "from 551 to 608 nm", 800);
}

void add_bad_files(Files& files) {
  files.refuses_text("an empty file", "", "the table is empty: a line with the names of the columns and then");
  files.refuses("only the header", "", "the table is empty: a row for each angle and wavelength is expected");
  files.refuses_text("a missing column", "theta_deg,wavelength_nm,Rs,Rd\n8,551,0.1,0.1\n", "there is no column \"T\"");
  files.refuses_text("a misspelt column", "theta,wavelength_nm,Rs,Rd,T\n8,551,0.1,0.1,0.1\n",
                     "there is no column \"theta\" in a leaf's table");
  files.refuses("a row too short", "8,551,0.1,0.1\n", "4 fields, but the file has 5 columns");
  files.refuses_text("a binary file",
                     std::string_view("\x7f"
                                      "ELF\0\0\xff\xfe",
                                      8),
                     "not a text file");
  files.refuses_file("no such file", files.name_of("none.csv"), "No such file or directory");
  files.refuses_file("a folder", files.folder(), "it is a folder");
}

}  // namespace

Theme table_files() {
  Theme theme{
      "Table files",
      "`leaf_simplified` with `tablefile` at 551 nm. For accepted files, Rs, Rd and T of the material are compared "
      "with the file at several angles."};
  Files files(theme);
  add_accepted(files);
  add_bad_numbers(files);
  add_bad_order(files);
  add_bad_files(files);
  return theme;
}

}  // namespace frond::stability
