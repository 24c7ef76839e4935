#include "world/gnss/signal.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

namespace skyloop::test {
namespace {

KeplerEphemeris delayed(Constellation constellation, NavigationMessage message) {
    KeplerEphemeris e;
    e.satellite = {constellation, 11};
    e.message = message;
    e.tgd = 3e-9;
    e.tgd2 = 5e-9;
    return e;
}

double delay_of(const Ephemeris& record, Signal signal) {
    const auto delay = group_delay(record, signal);
    EXPECT_TRUE(delay);
    return delay ? delay->value() : -1;
}

TEST(Signal, HasTheCarriersOfTheInterfaceDocuments) {
    EXPECT_EQ(carrier_frequency(Signal::l1).value(), 1575.42e6);
    EXPECT_EQ(carrier_frequency(Signal::l5).value(), 1176.45e6);
    EXPECT_EQ(carrier_frequency(Signal::b1i).value(), 1561.098e6);
    EXPECT_EQ(carrier_frequency(Signal::g1, -7).value(), 1598.0625e6);
    EXPECT_EQ(carrier_frequency(Signal::g2, 6).value(), 1248.625e6);
    // Every carrier but those of GLONASS and L5 is a multiple of 1.023 MHz over 2.
    for (const Signal s : {Signal::l1, Signal::l2, Signal::l5, Signal::e5b, Signal::e6, Signal::b1i, Signal::b3i}) {
        const double halves = carrier_frequency(s).value() / 511.5e3;
        EXPECT_NEAR(halves, std::round(halves), 1e-6);
    }
    EXPECT_EQ(first_signal(Constellation::galileo), Signal::l1);
    EXPECT_EQ(first_signal(Constellation::beidou), Signal::b1i);
    EXPECT_EQ(first_signal(Constellation::glonass), Signal::g1);
    EXPECT_EQ(first_signal(Constellation::navic), Signal::l5);
}

TEST(Signal, TakesTheGroupDelayOfEachSystemAndSignal) {
    const KeplerEphemeris gps = delayed(Constellation::gps, NavigationMessage::lnav);
    EXPECT_EQ(delay_of(gps, Signal::l1), 3e-9);
    EXPECT_NEAR(delay_of(gps, Signal::l2), 3e-9 * 77 * 77 / (60 * 60), 1e-20);  // IS-GPS-200: (77/60)²
    EXPECT_FALSE(group_delay(gps, Signal::l5));

    const KeplerEphemeris inav = delayed(Constellation::galileo, NavigationMessage::inav);
    EXPECT_EQ(delay_of(inav, Signal::l1), 5e-9);
    EXPECT_NEAR(delay_of(inav, Signal::e5b), 5e-9 * 154 * 154 / (118 * 118), 1e-20);
    EXPECT_FALSE(group_delay(inav, Signal::l5)) << "another clock";
    const KeplerEphemeris fnav = delayed(Constellation::galileo, NavigationMessage::fnav);
    EXPECT_EQ(delay_of(fnav, Signal::l1), 3e-9);
    EXPECT_NEAR(delay_of(fnav, Signal::l5), 3e-9 * 154 * 154 / (115 * 115), 1e-20);

    const KeplerEphemeris beidou = delayed(Constellation::beidou, NavigationMessage::d1);
    EXPECT_EQ(delay_of(beidou, Signal::b1i), 3e-9);
    EXPECT_EQ(delay_of(beidou, Signal::e5b), 5e-9);
    EXPECT_EQ(delay_of(beidou, Signal::b3i), 0);
    EXPECT_FALSE(group_delay(beidou, Signal::l1));
    EXPECT_NEAR(delay_of(delayed(Constellation::navic, NavigationMessage::lnav), Signal::l5), 3e-9 * 4.4870, 1e-13)
        << "what is broadcast is the delay of S band: (2492.028/1176.45)²";
    EXPECT_EQ(delay_of(delayed(Constellation::gps, NavigationMessage::almanac), Signal::l1), 0);

    GlonassEphemeris glonass;
    glonass.group_delay_l2 = 2e-9;
    EXPECT_EQ(delay_of(glonass, Signal::g1), 0);
    EXPECT_EQ(delay_of(glonass, Signal::g2), -2e-9);
    EXPECT_EQ(delay_of(SbasEphemeris{}, Signal::l1), 0);
}

TEST(SentGroupDelay, Is0WhereTheRecordDoesNotTellAndTheSatelliteSends) {
    const KeplerEphemeris gps = delayed(Constellation::gps, NavigationMessage::lnav);
    EXPECT_EQ(sent_group_delay(gps, Signal::l1), group_delay(gps, Signal::l1));
    EXPECT_EQ(sent_group_delay(gps, Signal::l5), Seconds(0));
    EXPECT_EQ(sent_group_delay(delayed(Constellation::galileo, NavigationMessage::inav), Signal::l5), Seconds(0));
    EXPECT_EQ(sent_group_delay(delayed(Constellation::beidou, NavigationMessage::d1), Signal::l5), Seconds(0));
    EXPECT_FALSE(sent_group_delay(gps, Signal::b1i));
    EXPECT_FALSE(sent_group_delay(gps, Signal::e5b));
    for (const Constellation c : {Constellation::gps, Constellation::galileo, Constellation::beidou})
        for (const TransmittedSignal& s : transmitted_signals(delayed(c, NavigationMessage::inav)))
            EXPECT_EQ(sent_group_delay(delayed(c, NavigationMessage::inav), s.signal), s.group_delay);
}

TEST(TableGroupDelay, IsThatAgainstThePairOfTheTable) {
    const auto of = [](const Ephemeris& record, Signal signal) { return table_group_delay(record, signal)->value(); };
    const auto combined = [&](const Ephemeris& record, Signal first, Signal second) {
        const double f1 = carrier_frequency(first).value(), f2 = carrier_frequency(second).value();
        return (f1 * f1 * of(record, first) - f2 * f2 * of(record, second)) / (f1 * f1 - f2 * f2);
    };
    const KeplerEphemeris gps = delayed(Constellation::gps, NavigationMessage::lnav);
    EXPECT_EQ(of(gps, Signal::l1), group_delay(gps, Signal::l1)->value()) << "GPS broadcasts the clock of L1 and L2";
    EXPECT_NEAR(combined(gps, Signal::l1, Signal::l2), 0, 1e-20);
    const KeplerEphemeris beidou = delayed(Constellation::beidou, NavigationMessage::d1);
    EXPECT_NEAR(of(beidou, Signal::b1i), -1.9437 * 3e-9, 1e-12);
    EXPECT_NEAR(combined(beidou, Signal::b1i, Signal::b3i), 0, 1e-20);
    const KeplerEphemeris fnav = delayed(Constellation::galileo, NavigationMessage::fnav);
    EXPECT_NEAR(combined(fnav, Signal::l1, Signal::l5), 0, 1e-20);
    const KeplerEphemeris inav = delayed(Constellation::galileo, NavigationMessage::inav);
    EXPECT_NEAR(of(inav, Signal::l1), of(fnav, Signal::l1), 1e-20) << "E1 is late by the same against E1 and E5a";
    EXPECT_FALSE(table_group_delay(inav, Signal::l5));
    GlonassEphemeris glonass;
    glonass.satellite = {Constellation::glonass, 1};
    glonass.group_delay_l2 = 2e-9;
    EXPECT_NEAR(combined(glonass, Signal::g1, Signal::g2), 0, 1e-20);
    EXPECT_EQ(of(SbasEphemeris{}, Signal::l1), 0);
    EXPECT_EQ(of(delayed(Constellation::galileo, NavigationMessage::almanac), Signal::l1), 0);
}

TEST(Signal, TellsHealthByTheSignalThatCarriesTheMessage) {
    KeplerEphemeris inav = delayed(Constellation::galileo, NavigationMessage::inav);
    KeplerEphemeris fnav = delayed(Constellation::galileo, NavigationMessage::fnav);
    inav.health = fnav.health = 0b000'010'000;  // E5a out of service
    EXPECT_TRUE(inav.healthy());
    EXPECT_FALSE(fnav.healthy());
    inav.health = fnav.health = 0b000'000'001;  // E1-B without guarantee
    EXPECT_FALSE(inav.healthy());
    EXPECT_TRUE(fnav.healthy());
    KeplerEphemeris qzss = delayed(Constellation::qzss, NavigationMessage::lnav);
    qzss.health = 0b000'001;  // L1C/B, as in all files since about 2023
    EXPECT_TRUE(qzss.healthy());
    for (const int health : {0b000'010, 0b010'000, 0b100'000, 0b111'111}) {
        qzss.health = health;
        EXPECT_FALSE(qzss.healthy()) << health;
    }
    KeplerEphemeris gps = delayed(Constellation::gps, NavigationMessage::lnav);
    gps.health = 1;
    EXPECT_FALSE(gps.healthy());
    SbasEphemeris sbas;
    sbas.health = 0b10;  // corrections off, ranging on
    EXPECT_TRUE(sbas.healthy());
    sbas.health = 31;  // message 17 has not come
    EXPECT_TRUE(sbas.healthy());
    for (const int health : {1, 15, 32, 63}) {
        sbas.health = health;
        EXPECT_FALSE(sbas.healthy()) << health;
    }
    EXPECT_TRUE(is_beidou_geo({Constellation::beidou, 5}));
    EXPECT_FALSE(is_beidou_geo({Constellation::beidou, 6}));
    EXPECT_TRUE(is_beidou_geo({Constellation::beidou, 59}));
    EXPECT_FALSE(is_beidou_geo({Constellation::gps, 5}));
}

TEST(Signal, TheSecondOneIsInTheBandThatIsAskedFor) {
    using enum Constellation;
    for (const Constellation c : {gps, qzss, galileo, beidou})
        EXPECT_EQ(second_signal(c, SecondBand::l5), Signal::l5) << constellation_name(c);
    EXPECT_EQ(second_signal(gps, SecondBand::l2), Signal::l2);
    EXPECT_EQ(second_signal(galileo, SecondBand::l2), Signal::e5b);
    EXPECT_EQ(second_signal(beidou, SecondBand::l2), Signal::e5b);
    EXPECT_EQ(second_signal(glonass, SecondBand::l2), Signal::g2);
    EXPECT_EQ(second_signal(glonass, SecondBand::l5), std::nullopt);
    EXPECT_EQ(second_signal(sbas, SecondBand::l2), std::nullopt);
    EXPECT_EQ(second_signal(navic, SecondBand::l5), std::nullopt);
}

TEST(Signal, B2iComesFromBeidou2AndB2aFromBeidou3Alone) {
    const auto sent = [](int number) {
        KeplerEphemeris record = delayed(Constellation::beidou, NavigationMessage::d1);
        record.satellite.number = number;
        std::vector<Signal> signals;
        for (const TransmittedSignal& s : transmitted_signals(record))
            signals.push_back(s.signal);
        return signals;
    };
    EXPECT_EQ(sent(16), (std::vector{Signal::b1i, Signal::e5b, Signal::b3i}));
    EXPECT_EQ(sent(19), (std::vector{Signal::b1i, Signal::b3i, Signal::l5}));
    EXPECT_EQ(sent(46), (std::vector{Signal::b1i, Signal::b3i, Signal::l5}));
    EXPECT_EQ(sent(59), (std::vector{Signal::b1i, Signal::b3i}));
    KeplerEphemeris galileo = delayed(Constellation::galileo, NavigationMessage::inav);
    galileo.satellite.number = 24;
    EXPECT_EQ(transmitted_signals(galileo).size(), 3U);
}

TEST(Signal, OfGpsAreWhatTheBlockOfTheDaySends) {
    KeplerEphemeris record = delayed(Constellation::gps, NavigationMessage::lnav);
    const auto sent = [&](int number, std::int64_t week) {
        record.satellite.number = number;
        record.toe = to_gps_time(week, 0.0);
        return transmitted_signals(record).size();
    };
    EXPECT_EQ(sent(13, 2300), 1U);
    EXPECT_EQ(sent(12, 2300), 2U);
    EXPECT_EQ(sent(11, 2300), 3U);
    EXPECT_EQ(sent(11, 2100), 1U);
}

}  // namespace
}  // namespace skyloop::test
