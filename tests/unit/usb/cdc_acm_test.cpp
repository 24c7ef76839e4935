#include "wire/usb/cdc_acm.hpp"

#include <gtest/gtest.h>

namespace skyloop {
namespace {

TEST(CdcUnion, IsFoundBehindOtherDescriptors) {
    const Bytes of_a_receiver{5, 0x24, 0, 0x10, 1, 4, 0x24, 2, 6, 5, 0x24, 6, 2, 3, 5, 0x24, 1, 0, 1};
    EXPECT_EQ(read_cdc_union(of_a_receiver), (CdcUnion{2, 3}));
    EXPECT_EQ(read_cdc_union(Bytes{6, 0x24, 6, 0, 4, 5}), (CdcUnion{0, 4})) << "the first of two subordinates";
}

TEST(CdcUnion, OfAnotherKindIsNone) {
    EXPECT_FALSE(read_cdc_union(Bytes{5, 0x25, 6, 0, 1})) << "an endpoint's";
    EXPECT_FALSE(read_cdc_union(Bytes{5, 0x24, 7, 0, 1}));
}

TEST(CdcUnion, IsNotReadOutOfBounds) {
    EXPECT_FALSE(read_cdc_union({}));
    EXPECT_FALSE(read_cdc_union(Bytes{5}));
    EXPECT_FALSE(read_cdc_union(Bytes{5, 0x24, 6, 0})) << "shorter than it says";
    EXPECT_FALSE(read_cdc_union(Bytes{4, 0x24, 6, 0})) << "no subordinate";
    EXPECT_FALSE(read_cdc_union(Bytes{0, 0x24, 6, 0, 1})) << "of no length, which would never end";
    EXPECT_FALSE(read_cdc_union(Bytes{200, 0x24, 6, 0, 1}));
}

}  // namespace
}  // namespace skyloop
