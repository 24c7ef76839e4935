#include "receiver/protocol/field.hpp"

#include <gtest/gtest.h>

#include <limits>
#include <set>

#include "receiver/protocol/field_lister.hpp"
#include "receiver/protocol/known_sbf.hpp"
#include "receiver/protocol/mavlink_vehicle.hpp"
#include "receiver/protocol/msp.hpp"
#include "support/ubx_message_types.hpp"

namespace skyloop {
namespace {

TEST(Field, ADeclarationHasNameScaleAndAbsence) {
    constexpr FieldFormat whole = field_format("tow_s*1e-3!4294967295");
    EXPECT_EQ(whole.name, "tow_s");
    EXPECT_TRUE(whole.scaled);
    EXPECT_EQ(whole.factor / whole.divisor, 1e-3);
    EXPECT_TRUE(whole.can_be_absent);
    EXPECT_EQ(whole.absent, 4294967295.0);
    constexpr FieldFormat bare = field_format("fix_type");
    EXPECT_EQ(bare.name, "fix_type");
    EXPECT_FALSE(bare.scaled || bare.can_be_absent);
    EXPECT_EQ(field_format("x*2^-9").divisor, 512);
    EXPECT_EQ(field_format("x*25e-2").factor, 25);
    EXPECT_EQ(field_format("x!-2e10").absent, -2e10);
}

TEST(Field, AValueIsInTheDeclaredUnit) {
    I4<"lat_deg*1e-7"> lat = 464774999;
    EXPECT_EQ(lat.value(), 46.4774999);
    EXPECT_EQ(lat, 464774999);
    U4<"phase_ms*2^-21"> phase = 1u << 20;
    EXPECT_EQ(phase.value(), 0.5);
    I4<"ecef_m*1e-2", 3> ecef = {1, -250, 3};
    EXPECT_EQ(ecef.value(1), -2.5);
    R4<"alt_m"> alt = 1.5F;
    EXPECT_EQ(alt.value(), 1.5);
}

TEST(Field, WhatIsAbsentHasNoValue) {
    U2<"h_acc_m*1e-2!65535"> accuracy = 65535;
    EXPECT_EQ(accuracy.value(), std::nullopt);
    accuracy = 150;
    EXPECT_EQ(accuracy.value(), 1.5);
    R4<"covariance_m2!-2e10", 2> covariance = {-2e10F, 4};
    EXPECT_EQ(covariance.value(0), std::nullopt);
    EXPECT_EQ(covariance.value(1), 4);
}

TEST(Field, SettingRoundsToTheNearestAndStaysInRange) {
    I4<"lat_deg*1e-7"> lat;
    lat.set(-30.73261234);
    EXPECT_EQ(lat, -307326123);
    lat.set(1e9);
    EXPECT_EQ(lat, std::numeric_limits<std::int32_t>::max());
    lat.set(std::numeric_limits<double>::quiet_NaN());
    EXPECT_EQ(lat, 0);
    U2<"h_acc_m*1e-2"> accuracy = 7;
    accuracy.set(-3);
    EXPECT_EQ(accuracy, 0);
    I4<"doppler_mps*4e-2"> doppler;
    doppler.set(0.1);
    EXPECT_EQ(doppler, 3);
    I4<"ecef_m*1e-2", 3> ecef;
    ecef.set(2, 12.345);
    EXPECT_EQ(ecef[2], 1235);
}

TEST(Field, AValueBeyondTheRangeIsNeverTakenForAbsence) {
    U2<"h_acc_m*1e-2!65535"> accuracy;
    accuracy.set(1e6);
    EXPECT_EQ(accuracy.value(), 655.34);
    I2<"elevation_deg*1e-2!-32768"> elevation;
    elevation.set(-1e6);
    EXPECT_EQ(elevation, -32767);
    U2<"pdop*1e-2!0"> dop = 1;
    dop.set(0);
    EXPECT_EQ(dop.value(), std::nullopt);
}

// Names of a message differ, those of its groups among them.
template <class Message>
void expect_distinct_names(const Message& message) {
    FieldLister lister;
    walk_fields(message, lister);
    std::set<std::string> names;
    for (const DecodedField& field : lister.take())
        EXPECT_TRUE(names.insert(field.name).second) << field.name;
    EXPECT_FALSE(names.empty());
}

TEST(Field, NamesOfAMessageDiffer) {
    UbxOutputTypes::for_each([](const auto& message) { expect_distinct_names(message); });
    UbxSettingTypes::for_each([](const auto& message) { expect_distinct_names(message); });
    const auto fresh = []<class Message>() {
        expect_distinct_names(Message{});
        return false;
    };
    KnownSbfBlocks::any(fresh);
    KnownMavlinkMessages::any(fresh);
    MessageTypes<MspSensorGps, MspSetRawGps>::any(fresh);
}

}  // namespace
}  // namespace skyloop
