#include "firmware/core/geofence.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <string>

#include "base/geo/geodetic.hpp"
#include "legacy_bench.hpp"
#include "receiver/protocol/ubx_cfg_navigation.hpp"
#include "receiver/protocol/ubx_services.hpp"
#include "ubx_reports.hpp"

namespace skyloop::firmware {
namespace {

// A circle of 100 m around a place so far north of the fix.
void put_fence(ConfigStore& config, std::uint32_t number, const Fix& fix, double north_m) {
    const FenceKeys keys(number);
    const GeodesicPoint centre = geodesic_direct(fix.position, Angle::degrees(0), Metres(north_m));
    config.set(in_ram, keys.use, 1);
    config.set(in_ram, keys.latitude, static_cast<std::uint32_t>(std::llround(centre.latitude.deg() * 1e7)));
    config.set(in_ram, keys.longitude, static_cast<std::uint32_t>(std::llround(centre.longitude.deg() * 1e7)));
    config.set(in_ram, keys.radius, 10000);
}

TEST(NavGeofenceMessage, TellsNothingWithoutFences) {
    const UbxReport m9(9);
    const auto told = m9.report<NavGeofence>();
    EXPECT_EQ(told.status, 0);
    EXPECT_EQ(told.comb_state, 0);
    EXPECT_TRUE(told.fences.empty());
}

TEST(NavGeofenceMessage, TellsTheSideOfEachFenceThatIsCertainEnough) {
    UbxReport m9(9);
    const Fix& fix = m9.state.epoch.fix;  // within 3.3 m
    put_fence(m9.config, 1, fix, 50);
    put_fence(m9.config, 2, fix, 94);
    put_fence(m9.config, 4, fix, 106);
    const auto states = [&](std::uint64_t confidence) {
        m9.config.set(in_ram, key::geofence_confidence, confidence);
        std::string text;
        for (const NavGeofenceItem& fence : m9.report<NavGeofence>().fences)
            text += std::to_string(fence.id) + ":" + std::to_string(fence.state) + " ";
        return text;
    };
    EXPECT_EQ(states(0), "1:1 2:1 4:2 ");
    EXPECT_EQ(states(1), "1:1 2:1 4:2 ");
    EXPECT_EQ(states(2), "1:1 2:0 4:0 ") << "6.6 m from the line on";
    EXPECT_EQ(m9.report<NavGeofence>().status, 1);
    EXPECT_EQ(m9.report<NavGeofence>().comb_state, 1) << "inside of one";
    m9.config.set(in_ram, FenceKeys(1).use, 0);
    EXPECT_EQ(m9.report<NavGeofence>().comb_state, 0);
    m9.config.set(in_ram, FenceKeys(2).use, 0);
    m9.config.set(in_ram, key::geofence_confidence, 1);
    EXPECT_EQ(m9.report<NavGeofence>().comb_state, 2) << "outside of all";
    m9.lose_fix();
    EXPECT_EQ(m9.report<NavGeofence>().status, 0);
    EXPECT_EQ(states(1), "4:0 ");
}

TEST(LegacyGeofence, IsAViewOfTheItems) {
    LegacyBench m8(legacy_m8());
    EXPECT_EQ(m8.poll(cfg(0x69)), hex("00 00 00 00 00 00 00 00"));
    const Bytes two = hex("00 02 03 00 01 01 06 00  40420F00 C0BDF0FF 10270000  00000000 00000000 64000000");
    EXPECT_EQ(m8.set(cfg(0x69), two), Verdict::acknowledge);
    EXPECT_EQ(m8.poll(cfg(0x69)), two);
    EXPECT_EQ(m8.store.value(key::geofence_confidence), 3u);
    EXPECT_EQ(m8.store.signed_value(FenceKeys(1).longitude), -1000000);
    EXPECT_EQ(m8.store.value(FenceKeys(2).radius), 100u);
    EXPECT_FALSE(m8.store.flag(FenceKeys(3).use));
    EXPECT_EQ(m8.set(cfg(0x69), hex("00 01 00 00 00 00 00 00  0100A535 00000000 64000000")), Verdict::refuse)
        << "beyond the pole";
    EXPECT_EQ(m8.set(cfg(0x69), hex("00 02 03 00 01 01 06 00  40420F00 C0BDF0FF 10270000")), Verdict::refuse);
    EXPECT_EQ(m8.set(cfg(0x69), hex("01 00 00 00 00 00 00 00")), Verdict::refuse);
    EXPECT_EQ(m8.poll(cfg(0x69)), two);
    EXPECT_EQ(m8.set(cfg(0x69), hex("00 00 00 00 00 00 00 00")), Verdict::acknowledge);
    EXPECT_FALSE(m8.store.flag(FenceKeys(1).use));
}

TEST(LegacyGeofence, ReadsWhatValsetHasSet) {
    LegacyBench f9(legacy_f9p());
    EXPECT_EQ(f9.valset("30 00 24 10 01 31 00 24 40 01 00 00 00 32 00 24 40 02 00 00 00 33 00 24 40 03 00 00 00"),
              Verdict::acknowledge);
    EXPECT_EQ(f9.poll(cfg(0x69)), hex("00 01 00 00 00 00 00 00  01000000 02000000 03000000"));
}

}  // namespace
}  // namespace skyloop::firmware
