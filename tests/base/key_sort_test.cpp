#include "lobelia/base/key_sort.h"

#include <gtest/gtest.h>

#include "lobelia/base/random.h"

namespace lobelia {
namespace {

struct Item {
  uint64_t key;
  size_t place;
};

TEST(KeySort, SortsAndKeepsTheOrderOfEqualOnes) {
  KeySort<Item> sort;
  Rng random(3);
  for (const size_t count : {0, 1, 5000, 7}) {
    for (const uint64_t most : {uint64_t{9}, (uint64_t{1} << 38) - 1}) {
      std::vector<Item> items;
      for (size_t i = 0; i < count; ++i)
        items.push_back({(uint64_t{random.nextUint()} << 20 ^ random.nextUint()) & most, i});
      std::vector<Item> expected = items;
      std::stable_sort(expected.begin(), expected.end(),
                       [](const Item& a, const Item& b) { return a.key < b.key; });
      sort.run(&items, [](const Item& item) { return item.key; });
      ASSERT_EQ(items.size(), count);
      for (size_t i = 0; i < count; ++i) {
        EXPECT_EQ(items[i].key, expected[i].key);
        EXPECT_EQ(items[i].place, expected[i].place);
      }
    }
  }
}

}  // namespace
}  // namespace lobelia
