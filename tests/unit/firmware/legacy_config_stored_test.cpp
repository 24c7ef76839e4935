#include <gtest/gtest.h>

#include "legacy_bench.hpp"
#include "receiver/protocol/ubx_cfg_device.hpp"
#include "receiver/protocol/ubx_cfg_navigation.hpp"

namespace skyloop::firmware {
namespace {

TEST(LegacyDatum, IsWgs84UntilTheUserHasOneOfHisOwn) {
    LegacyBench m8(legacy_m8());
    const auto told = [&] { return *decode_payload<CfgDat>(m8.poll(cfg(0x06))); };
    EXPECT_EQ(told().datum_num, 0);
    EXPECT_EQ(told().datum_name, (std::array<std::uint8_t, 6>{'W', 'G', 'S', '8', '4', 0}));
    EXPECT_EQ(told().maj_a, 6378137);
    EXPECT_EQ(told().flat, 298.257223563);
    CfgDatSet bessel{6377397.155, 299.1528128, {598.1F, 73.7F, 418.2F}, {0.202F, 0.045F, -2.455F}, 6.7F};
    EXPECT_EQ(m8.set(cfg(0x06), encode_payload(bessel)), Verdict::acknowledge);
    EXPECT_EQ(told().datum_num, 0xFFFF);
    EXPECT_EQ(told().maj_a, bessel.maj_a);
    EXPECT_EQ(told().flat, bessel.flat);
    EXPECT_EQ(told().shift, bessel.shift);
    EXPECT_EQ(told().rotation, bessel.rotation);
    EXPECT_EQ(told().scale, bessel.scale);
    bessel.maj_a = 1737400;
    EXPECT_EQ(m8.set(cfg(0x06), encode_payload(bessel)), Verdict::refuse) << "the moon";
    EXPECT_EQ(m8.set(cfg(0x06), Bytes(43)), Verdict::refuse);
}

// The first lines of what u-center writes of a receiver's configuration.
TEST(LegacyDatum, IsGivenByItsNumberToo) {
    LegacyBench m8(legacy_m8());
    const CfgDatSet bessel{6377397.155, 299.1528128, {598.1F, 73.7F, 418.2F}, {0.202F, 0.045F, -2.455F}, 6.7F};
    EXPECT_EQ(m8.set(cfg(0x06), encode_payload(bessel)), Verdict::acknowledge);
    EXPECT_EQ(m8.set(cfg(0x06), hex("0100")), Verdict::refuse) << "there is none but WGS 84";
    EXPECT_EQ(decode_payload<CfgDat>(m8.poll(cfg(0x06)))->datum_num, 0xFFFF);
    EXPECT_EQ(m8.set(cfg(0x06), hex("0000")), Verdict::acknowledge);
    EXPECT_EQ(decode_payload<CfgDat>(m8.poll(cfg(0x06)))->datum_num, 0);
    EXPECT_EQ(m8.set(cfg(0x06), hex("00")), Verdict::refuse);
}

TEST(LegacyPowerManagement, IsKeptToTheMillisecondAndTheBit) {
    LegacyBench m8(legacy_m8());
    EXPECT_EQ(decode_payload<CfgPm2>(m8.poll(cfg(0x3B)))->flags, 0x0142900Eu);
    CfgPm2 set;
    set.flags = 0x0040'1062;
    set.update_period = 1500;
    set.search_period = 20250;
    set.grid_offset = 7;
    set.on_time = 3;
    set.min_acq_time = 4;
    set.max_startup_state_dur = 9;
    set.extint_inactivity = 12345;
    EXPECT_EQ(m8.set(cfg(0x3B), encode_payload(set)), Verdict::acknowledge);
    EXPECT_EQ(m8.poll(cfg(0x3B)), encode_payload(set));
    EXPECT_EQ(m8.store.value(0x40D00002), 1u) << "CFG-PM-POSUPDATEPERIOD, s";
    EXPECT_TRUE(m8.store.flag(0x10D0000D)) << "CFG-PM-EXTINTBACKUP";
    EXPECT_EQ(m8.store.value(0x20D00001), 0u) << "at full power still";
    EXPECT_EQ(m8.set(cfg(0x11), hex("08 01")), Verdict::acknowledge);
    EXPECT_EQ(m8.store.value(0x20D00001), 1u) << "on and off, as CFG-PM2 says";
    EXPECT_EQ(m8.set(cfg(0x86), hex("00 02 0A00 0500 0000")), Verdict::acknowledge);
    EXPECT_EQ(decode_payload<CfgPm2>(m8.poll(cfg(0x3B)))->search_period, 10000u) << "of both";
    EXPECT_EQ(decode_payload<CfgPm2>(m8.poll(cfg(0x3B)))->update_period, 10000u) << "that of CFG-PMS";
    set.version = 1;
    EXPECT_EQ(m8.set(cfg(0x3B), encode_payload(set)), Verdict::refuse);
}

TEST(LegacyInventory, IsKeptUpToThirtyBytes) {
    LegacyBench m8(legacy_m8());
    EXPECT_EQ(to_string(ByteSpan(m8.poll(cfg(0x34))).subspan(1)), "Notice: no data saved!");
    Bytes label{3};
    for (std::uint8_t i = 0; i < 30; ++i)
        label.push_back(static_cast<std::uint8_t>(0xF0 + i));
    EXPECT_EQ(m8.set(cfg(0x34), label), Verdict::acknowledge);
    EXPECT_EQ(m8.poll(cfg(0x34)), label);
    EXPECT_TRUE(m8.store.flag(0x10C70002)) << "CFG-RINV-BINARY";
    label.push_back(0);
    EXPECT_EQ(m8.set(cfg(0x34), label), Verdict::refuse);
    EXPECT_EQ(m8.set(cfg(0x34), Bytes{0, 'a'}), Verdict::acknowledge);
    EXPECT_EQ(m8.poll(cfg(0x34)), (Bytes{0, 'a'}));
}

}  // namespace
}  // namespace skyloop::firmware
