#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/cli/table.h"
#include "tests/support/command_test.h"

namespace frond {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;
using ::testing::Not;

class InstancesCommand : public CommandTest {
 protected:
  /// The table that the command writes.
  std::string table_of(const std::string& text, const std::string& messages = "") {
    const std::string csv = folder_.write("rows.csv", text).string(), npy = path("rows.npy");
    const Outcome done = frond_command({"instances", csv, "-o", npy});
    EXPECT_EQ(done.code, 0) << done.err << text;
    EXPECT_THAT(done.err + done.out, HasSubstr(messages)) << text;
    messages_ = done.err + done.out;
    return bytes_of(npy);
  }
  std::string refusal(const std::string& text) {
    const std::string csv = folder_.write("bad.csv", text).string(), npy = path("bad.npy");
    const Outcome done = frond_command({"instances", csv, "-o", npy});
    EXPECT_EQ(done.code, 1) << text;
    EXPECT_FALSE(std::filesystem::exists(npy));
    return done.err;
  }

  std::string messages_;
};

TEST_F(InstancesCommand, EveryLayoutGivesTheSameTable) {
  const std::string plain = table_of("x,y,z,scale,zenith,azimuth,chl\n0.1,0.2,0.5,0.05,10,20,3\n1,2,3,.5,0,0,4\n");
  for (const std::string text : {
           "\xef\xbb\xbfx,y,z,scale,zenith,azimuth,chl\r\n0.1,0.2,0.5,0.05,10,20,3\r\n1,2,3,.5,0,0,4\r\n",
           "x;y;z;scale;zenith;azimuth;chl\n0,1;0,2;0,5;0,05;10;20;3\n1;2;3;,5;0;0;4\n",
           "x y z scale zenith azimuth chl\n0.1 0.2 0.5 0.05 10 20 3\n1 2 3 .5 0 0 4\n",
           "X\tY\tZ\tScale\tZenith\tAzimuth\tchl\n0.1\t0.2\t0.5\t0.05\t10\t20\t3\n1\t2\t3\t.5\t0\t0\t4\n",
           "\"x\",\"y\",\"z\",\"scale\",\"zenith\",\"azimuth\",\"chl\"\n0.1,0.2,0.5,0.05,10,20,3\n1,2,3,.5,0,0,4\n",
           ",x,y,z,scale,zenith,azimuth,chl\n0,0.1,0.2,0.5,0.05,10,20,3\n1,1,2,3,.5,0,0,4\n",
           "\"x\" \"y\" \"z\" \"scale\" \"zenith\" \"azimuth\" \"chl\"\n\"1\" 0.1 0.2 0.5 0.05 10 20 3\n\"2\" 1 2 3 .5 "
           "0 0 4\n",
           "# plants\nx,y,z,scale,zenith,azimuth,chl\n\n0.1,0.2,0.5,0.05,10,20,3 # one\n1,2,3,.5,0,0,4\n",
       })
    EXPECT_EQ(table_of(text), plain) << text;
}

TEST_F(InstancesCommand, ARadiusIsTheSize) {
  const std::string plain = table_of("scale,x,y,z,nx,ny,nz\n0.05,1,2,3,0,0,1\n.1,0,0,1,0,0.6,0.8\n");
  EXPECT_EQ(table_of("radius,x,y,z,nx,ny,nz\n0.05,1,2,3,0,0,1\n.1,0,0,1,0,0.6,0.8\n",
                     "the object that is placed has the radius 1"),
            plain);
  // A leaf cloud in the format of Eradiate and RAMI.
  EXPECT_EQ(table_of("0.05 1 2 3 0 0 1\n.1 0 0 1 0 0.6 0.8\n", "taken as radius x y z nx ny nz"), plain);
  EXPECT_THAT(refusal("0.05 1 2 3 0 0 1\n.1 0 0 1 0 0.6 0.9\n"),
              HasSubstr("bad.csv:2:10: the normal has the length 1.08"));
  EXPECT_THAT(refusal("0.05 1 2 3 0 0\n"),
              AllOf(HasSubstr("bad.csv:1:1: the first line holds 6 numbers"), HasSubstr("radius x y z nx ny nz")));
  EXPECT_THAT(refusal("radius,scale,x,y,z\n1,1,0,0,0\n"), HasSubstr("\"scale\" and \"radius\" both give the size"));
  EXPECT_THAT(refusal("radius,x,y,z\n0,0,0,0\n"), HasSubstr("bad.csv:2:1: the radius 0 is not above 0"));
}

TEST_F(InstancesCommand, OtherColumnsAreNamedOnce) {
  table_of("x,y,z,chl,age\n0,0,1,3,4\n1,0,1,3,4\n", "with numbers for Texture \"instance\": chl, age");
  EXPECT_THAT(messages_, Not(HasSubstr("warning")));
  table_of("x,y,z,diameter,theta\n0,0,1,3,4\n1,0,1,3,4\n",
           "\"diameter\", \"theta\" changes neither size nor orientation");
  table_of("x,y,z,scale,theta,nx,ny,nz,diameter\n0,0,1,3,4,0,0,1,2\n");
  EXPECT_THAT(messages_, Not(HasSubstr("neither size")));
}

TEST_F(InstancesCommand, FaultsHaveAPlace) {
  EXPECT_THAT(refusal("x;y;z\n0;0;1\n0;1.2,5;1\n"),
              HasSubstr("bad.csv:3:3: column \"y\" needs a number, \"1.2,5\" was given"));
  EXPECT_THAT(refusal("x,y,z,species\n0,0,1,oak\n"), HasSubstr("bad.csv:2:7: column \"species\" needs a number"));
  EXPECT_THAT(refusal("x,y,z\n0,0,1\n0,0\n"), HasSubstr("bad.csv:3:1: 2 fields, but the file has 3 columns"));
  EXPECT_THAT(refusal("x,X,y,z\n0,0,1,1\n"), HasSubstr("bad.csv:1:1: there are two columns \"x\""));
  EXPECT_THAT(refusal("x,y,z,a,a\n0,0,1,1,1\n"), HasSubstr("there are two columns \"a\""));
  EXPECT_THAT(refusal("\xff\xfex\n"), HasSubstr("UTF-16"));
}

}  // namespace
}  // namespace frond
