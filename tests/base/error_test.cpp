#include "lobelia/base/error.h"

#include <gtest/gtest.h>

namespace lobelia {
namespace {

TEST(Error, LocationLeavesOutWhatIsUnknown) {
  EXPECT_EQ(toString({"a.xml", 3, 7}), "a.xml:3:7");
  EXPECT_EQ(toString({"a.xml", 3, 0}), "a.xml:3");
  EXPECT_EQ(toString({"a.ply", 0, 9}), "a.ply");
}

TEST(Error, InputErrorNamesThePlace) {
  EXPECT_STREQ(InputError({"a.xml", 3, 0}, "no such shape").what(), "a.xml:3: no such shape");
  EXPECT_STREQ(InputError({}, "no such shape").what(), "no such shape");
}

TEST(Error, SuggestsTheNearestName) {
  const std::vector<std::string> known{"sphere", "rectangle", "cube", "roughConductor"};
  EXPECT_EQ(suggestion("shpere", known), "; did you mean 'sphere'?");
  EXPECT_EQ(suggestion("rectangel", known), "; did you mean 'rectangle'?");
  EXPECT_EQ(suggestion("roughconductor", known), "; did you mean 'roughConductor'?");
  EXPECT_EQ(suggestion("sglc", {"sg", "sglc-shared", "sglc-paper"}),
            "; did you mean 'sglc-shared'?");
  EXPECT_EQ(suggestion("cub", known), "; did you mean 'cube'?");
}

TEST(Error, SuggestsNothingFarAway) {
  EXPECT_EQ(suggestion("heightfield", {"sphere", "cube"}), "");
  EXPECT_EQ(suggestion("", {"sphere"}), "");
  EXPECT_EQ(suggestion("sphere", {}), "");
  EXPECT_EQ(suggestion(std::string(100000, 'x'), {"sphere"}), "");
}

}  // namespace
}  // namespace lobelia
