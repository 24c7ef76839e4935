// Logs of every kind, from bytes made here by the published layouts.
#include "receiver/observed/observed_log.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cstring>
#include <filesystem>
#include <limits>

#include "base/core/files.hpp"
#include "base/time/utc_time.hpp"
#include "receiver/observed/dataflash.hpp"
#include "receiver/protocol/ubx_mon.hpp"
#include "receiver/protocol/ubx_nav.hpp"
#include "receiver/protocol/ubx_satellites.hpp"
#include "support/log_bytes.hpp"
#include "support/oracle_table.hpp"

namespace skyloop {
namespace {

using test::append;
using test::ByteWriter;
using test::dataflash_format;
using test::dataflash_log;
using test::ulog_head;
using test::ulog_message;
using test::ulog_of;
using testing::HasSubstr;

ObservedLog read_whole(const Bytes& bytes, std::size_t receiver = 0) {
    auto log = read_observed(bytes, "x.log", {nullptr, receiver});
    EXPECT_TRUE(log.has_value()) << (log ? "" : log.error().message);
    return log ? std::move(*log) : ObservedLog{};
}

std::string refusal_of(const Bytes& bytes, std::size_t receiver = 0) {
    const auto log = read_observed(bytes, "x.log", {nullptr, receiver});
    EXPECT_FALSE(log.has_value());
    if (log) return {};
    EXPECT_EQ(log.error().message.find('\n'), std::string::npos);
    EXPECT_TRUE(log.error().message.starts_with("x.log: ")) << log.error().message;
    return log.error().message;
}

const GpsTime log_noon = to_gps_time(UtcTime{2024, 3, 5, 12, 0, 0, 0}, LeapSeconds::announced());

NavPvt pvt_at(unsigned second, std::uint8_t fix, std::uint8_t flags) {
    NavPvt pvt;
    pvt.i_tow = 216'018'000 + second * 1000;
    pvt.year = 2024, pvt.month = 3, pvt.day = 5, pvt.hour = 12, pvt.second = static_cast<std::uint8_t>(second);
    pvt.valid = 7;
    pvt.fix_type = fix, pvt.flags = flags, pvt.num_sv = 9;
    pvt.lat = 470000000, pvt.lon = 80000000, pvt.height = 500000;
    pvt.vel_n = 1000, pvt.h_acc = 1500;
    return pvt;
}

TEST(UbxLog, ReadsSolutionsSatellitesAndVersion) {
    MonVer version;
    std::memcpy(version.hw_version.data(), "000A0000", 8);
    std::memcpy(version.sw_version.data(), "ROM SPG 5.10", 12);
    Bytes bytes = encode_frame(version);
    append(bytes, encode_frame(pvt_at(0, 3, 1)));
    NavSat sat;
    sat.i_tow = 216'018'000, sat.version = 1;
    sat.satellites = {{0, 7, 44, 40, 0, 0, 0}, {6, 3, 0, 10, 0, 0, 0}, {2, 5, 39, 20, 0, 0, 0}};
    append(bytes, encode_frame(sat));
    append(bytes, encode_frame(pvt_at(1, 0, 0)));
    append(bytes, encode_frame(pvt_at(2, 3, 0x83)));
    const ObservedLog log = read_whole(bytes);
    EXPECT_EQ(log.format, "UBX");
    EXPECT_EQ(log.board, "ublox-m10");
    ASSERT_EQ(log.epochs.size(), 3u);
    EXPECT_EQ(log.epochs[0].time, log_noon);
    EXPECT_EQ(log.epochs[0].type, FixType::fix_3d);
    EXPECT_NEAR(log.epochs[0].place->latitude.deg(), 47, 1e-9);
    EXPECT_NEAR(log.epochs[0].place->height.above_ellipsoid.value(), 500, 1e-9);
    EXPECT_EQ(log.epochs[0].velocity->north, 1);
    ASSERT_EQ(log.epochs[0].signals.size(), 2u);
    EXPECT_EQ(to_string(log.epochs[0].signals[0].id), "G07");
    EXPECT_EQ(to_string(log.epochs[0].signals[1].id), "E05");
    EXPECT_TRUE(log.epochs[1].is_lost());
    EXPECT_FALSE(log.epochs[1].place.has_value());
    EXPECT_EQ(log.epochs[2].type, FixType::rtk_fixed);
}

TEST(UbxLog, CountsDamageAndKeepsTheRest) {
    Bytes bytes = encode_frame(pvt_at(0, 3, 1));
    Bytes broken = encode_frame(pvt_at(1, 3, 1));
    broken[20] ^= 0xFF;
    append(bytes, broken);
    append(bytes, encode_frame(pvt_at(2, 3, 1)));
    append(bytes, encode_frame(pvt_at(2, 3, 1)));
    append(bytes, encode_frame(pvt_at(1, 3, 1)));  // back in time
    const Bytes cut = encode_frame(pvt_at(3, 3, 1));
    bytes.insert(bytes.end(), cut.begin(), cut.begin() + 40);
    const ObservedLog log = read_whole(bytes);
    EXPECT_EQ(log.epochs.size(), 2u);
    EXPECT_THAT(log.notes, testing::Contains(HasSubstr("1 epochs that repeat a time or go back")));
    EXPECT_THAT(log.notes, testing::Contains(HasSubstr("wrong checksum")));
}

// From its start on a receiver counts the time of week from 0, until it knows better.
TEST(UbxLog, ColdStartsBeginWithTheWeek) {
    Bytes bytes;
    for (unsigned second = 0; second < 5; ++second) {
        NavPvt cold = pvt_at(second, 0, 0);
        cold.i_tow = 1000 * second, cold.valid = 0;
        append(bytes, encode_frame(cold));
    }
    append(bytes, encode_frame(pvt_at(7, 3, 1)));
    append(bytes, encode_frame(pvt_at(8, 3, 1)));
    const ObservedLog log = read_whole(bytes);
    ASSERT_EQ(log.epochs.size(), 2u);
    EXPECT_EQ(log.epochs[0].time, log_noon + std::chrono::seconds(7));
    EXPECT_THAT(log.notes, testing::Contains(HasSubstr("5 epochs before the receiver knew the week were left out")));
    const auto fixes = read_observed(bytes, "x.log", {nullptr, 0, ObservedUse::fixes});
    ASSERT_TRUE(fixes);
    EXPECT_EQ(fixes->epochs.size(), 7u) << "each says that it has no fix";
}

TEST(UbxLog, OldReceiversTellInSeveralMessages) {
    NavSol sol;
    sol.i_tow = 1000, sol.week = 1500, sol.gps_fix = 3, sol.flags = 0x0D, sol.num_sv = 7;
    NavPosllh llh;
    llh.i_tow = 1000, llh.lat = 470000000, llh.lon = 80000000, llh.height = 123000;
    NavVelned velocity;
    velocity.i_tow = 1000, velocity.vel_e = 250;
    Bytes bytes = encode_frame(sol);
    append(bytes, encode_frame(llh));
    append(bytes, encode_frame(velocity));
    const ObservedLog log = read_whole(bytes);
    ASSERT_EQ(log.epochs.size(), 1u);
    EXPECT_EQ(log.epochs[0].time, to_gps_time(1500, 1.0));
    EXPECT_NEAR(log.epochs[0].place->height.above_ellipsoid.value(), 123, 1e-6);
    EXPECT_EQ(log.epochs[0].velocity->east, 2.5);
}

std::string sentence_of(const std::string& body) {
    unsigned sum = 0;
    for (const char c : body)
        sum ^= static_cast<unsigned char>(c);
    char tail[8];
    std::snprintf(tail, sizeof tail, "*%02X\r\n", sum);
    return "$" + body + tail;
}

TEST(NmeaLog, DatesEpochsOverMidnight) {
    std::string text;
    text += sentence_of("GNGGA,235959.00,4700.00000,N,00800.00000,E,1,08,1.0,450.0,M,50.0,M,,");
    text += sentence_of("GPGSV,1,1,02,07,40,100,44,08,05,200,");
    text += sentence_of("GNGGA,000000.00,4700.00000,N,00800.00000,E,4,08,1.0,450.0,M,50.0,M,,");
    text += sentence_of("GNRMC,000000.00,A,4700.00000,N,00800.00000,E,0.0,,060324,,,R");
    text += sentence_of("GNGGA,000001.00,,,,,0,00,99.9,,M,,M,,");
    const ObservedLog log = read_whole(to_bytes(text));
    ASSERT_EQ(log.epochs.size(), 3u);
    EXPECT_EQ(log.format, "NMEA");
    EXPECT_EQ(log.epochs[1].time, to_gps_time(UtcTime{2024, 3, 6, 0, 0, 0, 0}, LeapSeconds::announced()));
    EXPECT_EQ(log.epochs[1].time - log.epochs[0].time, std::chrono::seconds(1));
    EXPECT_EQ(log.epochs[0].signals.size(), 1u);
    EXPECT_NEAR(log.epochs[0].place->height.above_ellipsoid.value(), 500, 1e-9);
    EXPECT_EQ(log.epochs[1].type, FixType::rtk_fixed);
    EXPECT_TRUE(log.epochs[2].is_lost());
    EXPECT_THAT(refusal_of(to_bytes(sentence_of("GNGGA,000001.00,,,,,0,00,99.9,,M,,M,,"))), HasSubstr("no date"));
}

// An epoch of 5 March 2024 with a fix, so many seconds after noon; its place tells which one it is.
std::string epoch_after_noon(int second, int number) {
    char body[200], date[80];
    const int of_day = 43200 + second;
    const int clock = of_day / 3600 * 10000 + of_day / 60 % 60 * 100 + of_day % 60;
    std::snprintf(body, sizeof body, "GPGGA,%06d.00,47%02d.0000,N,00800.0000,E,1,08,1.0,500.0,M,47.0,M,,", clock,
                  number);
    std::snprintf(date, sizeof date, "GPRMC,%06d.00,A,4700.0,N,00800.0,E,0,0,050324,,,A", clock);
    return sentence_of(date) + sentence_of(body);
}

TEST(NmeaLog, ADayWithALeapSecondIsASecondLonger) {
    const auto place = [](const char* time) {
        return sentence_of("GNGGA," + std::string(time) + ",4700.0000,N,00800.0000,E,1,08,1.0,500.0,M,47.0,M,,");
    };
    const ObservedLog log =
        read_whole(to_bytes(sentence_of("GNRMC,235959.00,A,4700.0,N,00800.0,E,0,0,311216,,,A") + place("235959.00") +
                            place("235960.00") + place("000000.00") + place("000001.00")));
    ASSERT_EQ(log.epochs.size(), 4u);
    for (int i = 1; i < 4; ++i)
        EXPECT_EQ(log.epochs[static_cast<std::size_t>(i)].time - log.epochs[0].time, std::chrono::seconds(i)) << i;
}

TEST(NmeaLog, OneTimeThatRanAheadCostsItsEpochAlone) {
    for (const int wrong : {0, 10, 19}) {
        std::string text;
        for (int i = 0; i < 20; ++i)
            text += epoch_after_noon(i == wrong ? 7200 : i, i);
        const ObservedLog log = read_whole(to_bytes(text));
        ASSERT_EQ(log.epochs.size(), wrong == 19 ? 20u : 19u) << wrong;  // the last one may be right
        EXPECT_EQ(log.epochs.front().time, log_noon + std::chrono::seconds(wrong == 0 ? 1 : 0));
        if (wrong < 19) {
            EXPECT_THAT(log.notes, testing::ElementsAre(HasSubstr("1 epochs have a time that ran ahead")));
        }
    }
}

TEST(NmeaLog, EpochsWithoutAFixNeverOutdateThoseWithOne) {
    std::string text;
    for (int i = 0; i < 3; ++i)
        text += sentence_of("GPRMC,20000" + std::to_string(i) + ".00,V,4700.0,N,00800.0,E,0,0,050324,,,N");
    for (int i = 0; i < 5; ++i)
        text += epoch_after_noon(i, i);
    text += sentence_of("GPRMC,120005.00,V,,,,,,,050324,,,N") + epoch_after_noon(6, 6);
    const ObservedLog log = read_whole(to_bytes(text));
    ASSERT_EQ(log.epochs.size(), 7u);
    EXPECT_EQ(log.epochs.front().time, log_noon);
    EXPECT_TRUE(log.epochs[5].is_lost());
    EXPECT_EQ(log.epochs[5].time, log_noon + std::chrono::seconds(5));
}

TEST(NmeaLog, AFewPolledMessagesDoNotHideIt) {
    std::string text;
    for (int i = 0; i < 5; ++i)
        text += epoch_after_noon(i, i);
    Bytes bytes = to_bytes(text);
    append(bytes, encode_frame(pvt_at(5, 3, 1)));
    const ObservedLog nmea = read_whole(bytes);
    EXPECT_EQ(nmea.format, "NMEA");
    EXPECT_EQ(nmea.epochs.size(), 5u);
    EXPECT_THAT(nmea.notes,
                testing::ElementsAre("5 epochs of NMEA and 1 of UBX have a place; those of NMEA are taken"));
    append(bytes, encode_frame(pvt_at(6, 3, 1)));
    append(bytes, encode_frame(pvt_at(7, 3, 1)));
    const ObservedLog ubx = read_whole(bytes);
    EXPECT_EQ(ubx.format, "UBX");
    EXPECT_THAT(ubx.notes, testing::ElementsAre("5 epochs of NMEA and 3 of UBX have a place; those of UBX are taken"));
}

TEST(NmeaLog, PutsRecordingsOfOneFileInTheirOrder) {
    std::string text;
    for (int i = 0; i < 10; ++i)
        text += epoch_after_noon(3600 + i, i);
    for (int i = 0; i < 5; ++i)
        text += epoch_after_noon(i, 20 + i);
    const ObservedLog log = read_whole(to_bytes(text));
    ASSERT_EQ(log.epochs.size(), 15u);
    EXPECT_EQ(log.epochs.front().time, log_noon);
    EXPECT_EQ(log.epochs.back().time, log_noon + std::chrono::seconds(3609));
    EXPECT_THAT(log.notes, testing::ElementsAre(HasSubstr("2 recordings do not follow each other in time")));
}

TEST(Ulog, ReadsRecordsByName) {
    const ObservedLog log = read_whole(ulog_of(4, 1).bytes, 1);
    EXPECT_EQ(log.format, "ULog");
    ASSERT_EQ(log.epochs.size(), 4u);  // the first by the autopilot's clock
    EXPECT_EQ(log.epochs[1].time - log_noon, std::chrono::milliseconds(200));
    EXPECT_EQ(log.epochs[0].time, log_noon);
    EXPECT_NEAR(log.epochs[0].place->height.above_ellipsoid.value(), 500, 1e-9);
    EXPECT_EQ(log.epochs[0].velocity->down, -3);
    EXPECT_EQ(*log.epochs[0].satellites_used, 11);
    EXPECT_THAT(log.notes, testing::Contains(HasSubstr("1 dropouts of the logger, 35 ms")));
}

TEST(Ulog, PassesOverDamageAndRefusesTheUnknown) {
    EXPECT_THAT(refusal_of(ulog_of(4, 1).bytes, 0), HasSubstr("of receiver 0"));
    EXPECT_THAT(refusal_of(ulog_head(0x02).bytes), HasSubstr("unknown incompatible flag bits 0x02"));
    EXPECT_THAT(refusal_of(ulog_head().bytes), HasSubstr("without records of vehicle_gps_position"));
    Bytes start = ulog_head().bytes;
    start.resize(10);
    EXPECT_THAT(refusal_of(start), HasSubstr("header of 10 bytes"));
    ByteWriter log = ulog_of(4, 0);
    log.bytes.resize(log.bytes.size() - 30);  // in the last record
    EXPECT_EQ(read_whole(log.bytes).epochs.size(), 3u);
    // Formats that hold themselves, or more than memory does.
    for (const std::string format :
         {"sensor_gps:sensor_gps a;", "sensor_gps:uint8_t[4000000000] a;", "sensor_gps:x[9999] a;"}) {
        ByteWriter hostile = ulog_head();
        ulog_message(hostile, 'F', to_bytes("x:x[9999] a;"));
        ulog_message(hostile, 'F', to_bytes(format));
        ulog_message(hostile, 'A', ByteWriter().put(std::uint8_t{0}).put(std::uint16_t{5}).text("sensor_gps").bytes);
        EXPECT_THAT(refusal_of(hostile.bytes), HasSubstr("without records")) << format;
    }
}

TEST(Ulog, CountsThatAreNoneAreNought) {
    for (const float value : {1e30F, -7.0F, std::numeric_limits<float>::quiet_NaN()}) {
        ByteWriter log = ulog_head();
        ulog_message(log, 'F',
                     to_bytes("sensor_gps:float timestamp;uint64_t time_utc_usec;float fix_type;float "
                              "satellites_used;"));
        ulog_message(log, 'A', ByteWriter().put(std::uint8_t{0}).put(std::uint16_t{5}).text("sensor_gps").bytes);
        for (unsigned i = 0; i < 3; ++i) {
            ByteWriter record;
            record.put(std::uint16_t{5}).put(value).put(std::uint64_t{1'709'640'000'000'000} + i * 200'000u);
            record.put(value).put(value);
            ulog_message(log, 'D', record.bytes);
        }
        const ObservedLog read = read_whole(log.bytes);
        ASSERT_EQ(read.epochs.size(), 3U);
        EXPECT_EQ(read.epochs[0].type, FixType::none);
        EXPECT_EQ(*read.epochs[0].satellites_used, 0);
    }
}

TEST(Dataflash, ReadsTheAskedReceiver) {
    const ObservedLog log = read_whole(dataflash_log(true).bytes);
    EXPECT_EQ(log.format, "DataFlash");
    ASSERT_EQ(log.epochs.size(), 5u);
    EXPECT_EQ(log.epochs[0].time, log_noon);
    EXPECT_EQ(log.epochs[0].type, FixType::rtk_fixed);
    EXPECT_TRUE(log.epochs[2].is_lost());
    EXPECT_NEAR(log.epochs[0].place->height.above_ellipsoid.value(), 500, 1e-6);  // Alt 450 less Und −50
    EXPECT_NEAR(log.epochs[4].place->height.above_ellipsoid.value(), 500, 1e-6);
    EXPECT_NEAR(log.epochs[0].velocity->east, 10, 1e-6);
    EXPECT_NEAR(log.epochs[0].horizontal_accuracy->value(), 1.5, 1e-9);
    EXPECT_EQ(read_whole(dataflash_log(true).bytes, 1).epochs.at(2).type, FixType::fix_3d);
}

TEST(Dataflash, CountsThatAreNoneAreNought) {
    for (const float value : {1e30F, -7.0F, std::numeric_limits<float>::quiet_NaN()}) {
        ByteWriter log;
        dataflash_format(log, 130, "GPS", "QBIHff", "TimeUS,I,GMS,GWk,Status,NSats");
        for (std::uint32_t i = 0; i < 3; ++i) {
            log.put(std::uint8_t{0xA3}).put(std::uint8_t{0x95}).put(std::uint8_t{130}).put(std::uint64_t{i});
            log.put(std::uint8_t{0}).put(std::uint32_t{216'018'000 + i * 200}).put(std::uint16_t{2304});
            log.put(value).put(value);
        }
        const ObservedLog read = read_whole(log.bytes);
        ASSERT_EQ(read.epochs.size(), 3U);
        EXPECT_EQ(read.epochs[0].type, FixType::none);
        EXPECT_EQ(*read.epochs[0].satellites_used, 0);
    }
}

// LogStructure.h, log_Multipliers: letters from 'A' on are tenths, hundredths, …, digits are powers of ten.
TEST(Dataflash, ScalesByMultipliersOfFmtu) {
    ByteWriter log;
    dataflash_format(log, 140, "TEST", "HHHH", "Plain,Tens,Hundreds,Tenths");
    log.put(std::uint8_t{0xA3}).put(std::uint8_t{0x95}).put(std::uint8_t{128}).put(std::uint8_t{129});
    log.put(std::uint8_t{44}).text("FMTU", 4).text("QBNN", 16).text("TimeUS,FmtType,UnitIds,MultIds", 64);
    log.put(std::uint8_t{0xA3}).put(std::uint8_t{0x95}).put(std::uint8_t{129}).put(std::uint64_t{0});
    log.put(std::uint8_t{140}).text("----", 16).text("012A", 16);
    log.put(std::uint8_t{0xA3}).put(std::uint8_t{0x95}).put(std::uint8_t{140});
    for (int i = 0; i < 4; ++i)
        log.put(std::uint16_t{7});
    DataflashReader reader(log.bytes);
    const auto record = reader.next();
    ASSERT_TRUE(record.has_value());
    EXPECT_DOUBLE_EQ(record->value("Plain").value_or(0), 7);
    EXPECT_DOUBLE_EQ(record->value("Tens").value_or(0), 70);
    EXPECT_DOUBLE_EQ(record->value("Hundreds").value_or(0), 700);
    EXPECT_DOUBLE_EQ(record->value("Tenths").value_or(0), 0.7);
}

TEST(Dataflash, RefusesWhatItCannotPlace) {
    EXPECT_THAT(refusal_of(dataflash_log(false).bytes), HasSubstr("the geoid's grid is not there"));
    EXPECT_THAT(refusal_of(dataflash_log(true).bytes, 2), HasSubstr("without GPS records of receiver 2"));
    Bytes cut = dataflash_log(true).bytes;
    cut.resize(cut.size() - 5);
    EXPECT_THAT(read_whole(cut).notes, testing::Contains(HasSubstr("cut by the end")));
}

TEST(ReceiverLogs, RefuseWhatIsNone) {
    EXPECT_THAT(refusal_of({}), HasSubstr("is empty"));
    EXPECT_THAT(refusal_of(Bytes(100000, 0)), HasSubstr("expected a UBX, NMEA, SBF, ULog or DataFlash log"));
    EXPECT_THAT(refusal_of(to_bytes("hello\n")), HasSubstr("0 UBX messages and 0 NMEA sentences in 6 bytes"));
    EXPECT_THAT(refusal_of(encode_frame(pvt_at(0, 3, 1)), 1), HasSubstr("--gps 1 is not in it"));
}

// Counts of MEASURED.md and MANIFEST.md.
struct RealLog {
    std::string path, format;
    std::size_t least_epochs, most_epochs, least_fixes, most_fixes;
};

class RealLogs : public testing::TestWithParam<RealLog> {};

TEST_P(RealLogs, LoadWithTheCountsThatWereMeasured) {
    SKYLOOP_REQUIRE_SHARED(file, GetParam().path);
    const auto text = read_text_file(file);
    ASSERT_TRUE(text.has_value());
    const ObservedLog log = read_whole(to_bytes(*text));
    EXPECT_EQ(log.format, GetParam().format);
    EXPECT_GE(log.epochs.size(), GetParam().least_epochs);
    EXPECT_LE(log.epochs.size(), GetParam().most_epochs);
    std::size_t fixes = 0;
    for (const ObservedEpoch& epoch : log.epochs)
        if (!epoch.is_lost()) ++fixes;
    EXPECT_GE(fixes, GetParam().least_fixes);
    EXPECT_LE(fixes, GetParam().most_fixes);
}

TEST(RealDataflash, AsksForTheGeoidWhereTheLogHasNoUndulation) {
    SKYLOOP_REQUIRE_SHARED(file, "tracks/test.BIN");
    EXPECT_THAT(refusal_of(to_bytes(*read_text_file(file))), HasSubstr("the geoid's grid is not there"));
}

INSTANTIATE_TEST_SUITE_P(
    Measured, RealLogs,
    testing::Values(
        // 582 s of besancon begin with 14 epochs without a week. NAV-SOL: 2555 fixes of 3687 s, then the survey ends
        // and the position is fixed (time only).
        RealLog{"receivers/galway_20181015_m8p_static/base-20181015-1654.ubx.gz", "UBX", 3687, 3687, 2555, 2555},
        RealLog{"receivers/besancon_20250425_ublox/16dBatt_no_interference_coldstart.ubx.gz", "UBX", 552, 582, 552,
                552},
        RealLog{"receivers/bend_f9t/F9T-L2-5min.ubx.gz", "UBX", 299, 299, 299, 299},
        RealLog{"receivers/indoor_neo6m_20240726/gps_data_20240726_122435.log.gz", "NMEA", 3840, 3840, 3759, 3759},
        RealLog{"tracks/sample_log_small.ulg", "ULog", 32, 32, 32, 32}));

}  // namespace
}  // namespace skyloop
