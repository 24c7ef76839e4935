// Fields of RTCM 3 messages as `decode` lists them, against bits laid out as RTCM 10403.3 has them.
#include <fmt/format.h>
#include <fmt/ranges.h>
#include <gtest/gtest.h>

#include "base/core/bytes.hpp"
#include "receiver/protocol/field_lister.hpp"
#include "receiver/protocol/rtcm3.hpp"
#include "receiver/protocol/rtcm3_legacy.hpp"
#include "receiver/protocol/rtcm3_ublox.hpp"

namespace skyloop {
namespace {

class Rtcm3Writer {
public:
    explicit Rtcm3Writer(unsigned number) { bits(number, 12); }
    Rtcm3Writer& bits(std::uint64_t value, int width) { return writer_.put(value, width), *this; }
    Rtcm3Writer& whole(std::int64_t value, int width) { return writer_.put_signed(value, width), *this; }
    Rtcm3Writer& text(std::string_view characters) {
        bits(characters.size(), 8);
        for (const char c : characters)
            bits(static_cast<unsigned char>(c), 8);
        return *this;
    }
    [[nodiscard]] Bytes bytes() const { return writer_.bytes(); }

private:
    BitWriter writer_;
};

std::string shown(const DecodedValue& value) {
    if (const auto* number = std::get_if<std::uint64_t>(&value.content)) return fmt::format("{}", *number);
    if (const auto* scaled = std::get_if<double>(&value.content)) return fmt::format("{:.4f}", *scaled);
    if (const auto* text = std::get_if<std::string>(&value.content)) return *text;
    if (const auto* list = std::get_if<std::vector<DecodedValue>>(&value.content)) {
        std::vector<std::string> parts;
        for (const DecodedValue& part : *list)
            parts.push_back(shown(part));
        return fmt::format("[{}]", fmt::join(parts, " "));
    }
    return "?";
}

// "NUMBER NAME: FIELD=VALUE …", or its payload's size where it is not listed.
std::string listed(const Bytes& payload) {
    DecodedMessage message;
    list_rtcm3(payload, message);
    std::string line = fmt::format("{} {}:", message.id, message.name);
    for (const DecodedField& field : message.fields)
        line += fmt::format(" {}={}", field.name, shown(field.value));
    return message.fields.empty() ? line + fmt::format(" {} bytes", message.payload.size()) : line;
}

// Messages 1005 and 1006: DF025 to DF027 with the bits between them, DF028.
Bytes station(unsigned number) {
    Rtcm3Writer writer(number);
    writer.bits(7, 12).bits(14, 6).bits(0b1111, 4).whole(-12345678901, 38).bits(0b11, 2).whole(2, 38);
    writer.bits(0b11, 2).whole(45678901234, 38);
    if (number == 1006) writer.bits(15000, 16);
    return writer.bytes();
}

TEST(Rtcm3Listing, StationsHaveAPlaceAndAHeight) {
    EXPECT_EQ(listed(station(1005)),
              "1005 station position: station=7 itrf_year=14 ecef_x_m=-1234567.8901 ecef_y_m=0.0002 "
              "ecef_z_m=4567890.1234");
    EXPECT_EQ(listed(station(1006)),
              "1006 station position and antenna height: station=7 itrf_year=14 ecef_x_m=-1234567.8901 "
              "ecef_y_m=0.0002 ecef_z_m=4567890.1234 antenna_height_m=1.5000");
}

TEST(Rtcm3Listing, AntennasAndReceiversAreNamedAsFarAsTheMessageDoes) {
    const auto antenna = [](unsigned number) {
        Rtcm3Writer writer(number);
        writer.bits(7, 12).text("ADVNULLANTENNA").bits(3, 8);
        return writer;
    };
    EXPECT_EQ(listed(antenna(1007).bytes()), "1007 antenna: station=7 antenna=ADVNULLANTENNA antenna_setup=3");
    EXPECT_EQ(listed(antenna(1008).text("A1").bytes()),
              "1008 antenna: station=7 antenna=ADVNULLANTENNA antenna_setup=3 antenna_serial=A1");
    EXPECT_EQ(listed(antenna(1033).text("A1").text("SKY").text("1.0").text("").bytes()),
              "1033 receiver and antenna: station=7 antenna=ADVNULLANTENNA antenna_setup=3 antenna_serial=A1 "
              "receiver=SKY firmware=1.0 receiver_serial=");
}

TEST(Rtcm3Listing, ObservablesAreDatedAsTheirSystemCounts) {
    const auto head = [](unsigned number, int width) {
        return Rtcm3Writer(number).bits(7, 12).bits(86399123, width).bits(1, 1).bits(9, 5).bits(11, 4).bytes();
    };
    for (const unsigned gps : {1001U, 1002U, 1003U, 1004U})
        EXPECT_NE(
            listed(head(gps, 30))
                .find("station=7 tow_s=86399.1230 more_follow=1 satellites=9 divergence_free=1 smoothing_interval=3"),
            std::string::npos);
    for (const unsigned glonass : {1009U, 1010U, 1011U, 1012U})
        EXPECT_NE(listed(head(glonass, 27))
                      .find("station=7 time_of_day_s=86399.1230 more_follow=1 satellites=9 divergence_free=1 "
                            "smoothing_interval=3"),
                  std::string::npos);
    EXPECT_NE(listed(head(1003, 30)).find("1003 GPS L1 and L2 observables, basic: "), std::string::npos);
    EXPECT_NE(listed(head(1009, 27)).find("1009 GLONASS L1 observables, basic: "), std::string::npos);
}

TEST(Rtcm3Listing, MsmTellTheirSatellitesAndSignals) {
    const auto tail = [](Rtcm3Writer& writer) {
        writer.bits(0, 1).bits(5, 3).bits(0, 7).bits(1, 2).bits(2, 2).bits(1, 1).bits(4, 3);
        return writer.bits(0x8000000000000001, 64).bits(0x40000000, 32).bytes();
    };
    const std::string rest =
        " more_follow=0 issue=5 clock_steering=1 external_clock=2 smoothing=1 smoothing_interval=4 "
        "satellites=[1 64] signals=[2]";
    Rtcm3Writer gps(1077), glonass(1084);
    gps.bits(7, 12).bits(345600500, 30);
    glonass.bits(7, 12).bits(4, 3).bits(3600000, 27);
    EXPECT_EQ(listed(tail(gps)), "1077 GPS MSM7: station=7 tow_s=345600.5000" + rest);
    EXPECT_EQ(listed(tail(glonass)), "1084 GLONASS MSM4: station=7 day_of_week=4 time_of_day_s=3600.0000" + rest);
    EXPECT_EQ(listed(Rtcm3Writer(1078).bits(0, 400).bytes()), "1078 : 52 bytes") << "there is no MSM8";
}

TEST(Rtcm3Listing, MsmTellTheirCells) {
    Rtcm3MsmObservations m;
    m.number = 1074;
    m.cells.resize(1);
    m.cells[0].satellite = 9;
    m.cells[0].range_m = 2.2e7;
    m.cells[0].lock_s = 1.5;
    m.cells[0].cno_dbhz = 43;
    const Bytes frame = encode(m);
    DecodedMessage message;
    list_rtcm3(parse_rtcm3(frame)->payload, message);
    const std::string line = text_line(message);
    EXPECT_NE(line.find("cells=[{satellite=9 signal=2 pseudorange_m=21999999.9911"), std::string::npos) << line;
    EXPECT_NE(line.find(" phase_range_m=- range_rate_mps=- lock_s=1.024 half_cycle_unknown=0 cno_dbhz=43}]"),
              std::string::npos)
        << line;
}

TEST(Rtcm3Listing, ObservablesTellTheirCells) {
    Rtcm3LegacyObservables m{1012, 7, 0, false, {}, true, 3};
    m.satellites.resize(1);
    m.satellites[0] = {9, -2, {0, 2.2e7, 2.2e7 + 1.5, 0.19, 3, 43}, Rtcm3LegacyCarrier{1, 2.2e7, {}, 0.24, 0, 40.25}};
    const Bytes frame = encode(m);
    DecodedMessage message;
    list_rtcm3(parse_rtcm3(frame)->payload, message);
    const std::string line = text_line(message);
    EXPECT_NE(line.find("satellites=1 divergence_free=1 smoothing_interval=3 cells=[{satellite=9 frequency_channel=-2 "
                        "l1_code=0 l1_pseudorange_m=21999999.99"),
              std::string::npos)
        << line;
    EXPECT_NE(line.find(" l1_lock_s=3 l1_cno_dbhz=43 l2_code=1 l2_pseudorange_m=21999999.99"), std::string::npos)
        << line;
    EXPECT_NE(line.find(" l2_phase_range_m=- l2_lock_s=0 l2_cno_dbhz=40.25}]"), std::string::npos) << line;
}

// Whole, of zeros but for what is put first.
Bytes filled(Rtcm3Writer writer, std::size_t size) {
    Bytes bytes = writer.bytes();
    bytes.resize(size);
    return bytes;
}

TEST(Rtcm3Listing, EphemeridesTellTheirFieldsInTheirUnits) {
    // DF009, DF076, DF077, DF078, DF079, DF071, DF081.
    const Bytes gps = filled(
        Rtcm3Writer(1019).bits(31, 6).bits(337, 10).bits(1, 4).bits(1, 2).bits(0, 14).bits(9, 8).bits(32400, 16), 61);
    EXPECT_TRUE(
        listed(gps).starts_with("1019 GPS ephemeris: satellite=31 week=337 accuracy=1 codes_on_l2=1 "
                                "idot_radps=0.0000 iode=9 toc_s=518400 af2_sps2=0.0000"))
        << listed(gps);
    // DF429, DF430.
    const Bytes qzss = filled(Rtcm3Writer(1044).bits(9, 4).bits(1, 16), 61);
    EXPECT_TRUE(listed(qzss).starts_with("1044 QZSS ephemeris: satellite=9 toc_s=16 ")) << listed(qzss);
    // DF038, DF040, DF104 to DF111: minus 1000 km/s · 2^-20.
    const Bytes glonass = filled(Rtcm3Writer(1020)
                                     .bits(24, 6)
                                     .bits(2, 5)
                                     .bits(3, 2)
                                     .bits(1, 2)
                                     .bits(23, 5)
                                     .bits(59, 6)
                                     .bits(1, 1)
                                     .bits(0, 1)
                                     .bits(1, 1)
                                     .bits(95, 7)
                                     .bits(0x8003E8, 24),
                                 45);
    EXPECT_TRUE(listed(glonass).starts_with(
        "1020 GLONASS ephemeris: satellite=24 channel=2 almanac_health=1 almanac_health_told=1 p1=1 tk_hours=23 "
        "tk_minutes=59 tk_half_minute=1 malfunction=0 p2=1 tb_s=85500 velocity_x_mps=-0.9537 x_m=0.0000"))
        << listed(glonass);
    EXPECT_TRUE(
        listed(filled(Rtcm3Writer(1041).bits(3, 6), 61)).starts_with("1041 NavIC ephemeris: satellite=3 week=0"));
    EXPECT_TRUE(
        listed(filled(Rtcm3Writer(1042).bits(3, 6), 64)).starts_with("1042 BeiDou ephemeris: satellite=3 week=0"));
    EXPECT_NE(listed(filled(Rtcm3Writer(1045).bits(3, 6), 62)).find("e5a_invalid=0"), std::string::npos);
    EXPECT_NE(listed(filled(Rtcm3Writer(1046).bits(3, 6), 63)).find("e1_invalid=0"), std::string::npos);
    EXPECT_EQ(listed(filled(Rtcm3Writer(1019).bits(31, 6), 60)), "1019 GPS ephemeris: 60 bytes") << "cut";
    EXPECT_EQ(listed(Rtcm3Writer(1043).bits(9, 4).bytes()), "1043 : 2 bytes");
}

TEST(Rtcm3Listing, UbloxsOwnAreListedAsFarAsTheyAreKnown) {
    const auto listed_frame = [](const Bytes& frame) {
        const ByteSpan payload = parse_rtcm3(frame)->payload;
        DecodedMessage message;
        list_rtcm3(payload, message);
        return text_line(message);
    };
    const std::string moving =
        listed_frame(encode(Rtcm3MovingStation{{7, 1, 500}, {10'000, -1, 0}, {-1500, 0, 1}, 21, 30}));
    EXPECT_NE(moving.find("subtype=0 station=7 kind=1 tow_s=0.5 ecef_x_m=1 ecef_y_m=-0.0001 ecef_z_m=0 "
                          "velocity_x_mps=-1.5 velocity_y_mps=0 velocity_z_mps=0.001 position_acc_m=0.021 "
                          "velocity_acc_mps=0.03"),
              std::string::npos)
        << moving;
    const std::string biases = listed_frame(encode(Rtcm3StationBiases{{7, 2, 500}, {{6, 1, -20, 3}}}));
    EXPECT_NE(biases.find("subtype=1 station=7 kind=2 tow_s=0.5 biases=[{gnss_id=6 band=1 offset=-20 deviation=3}]"),
              std::string::npos)
        << biases;
    EXPECT_EQ(listed(Rtcm3Writer(4072).bits(2, 12).bytes()), "4072 u-blox reference station: subtype=2");
}

TEST(Rtcm3Listing, CutMessagesKeepTheirBytes) {
    const Bytes whole = station(1006);
    for (std::size_t size = 0; size < whole.size(); ++size)
        EXPECT_NE(listed({whole.begin(), whole.begin() + static_cast<std::ptrdiff_t>(size)})
                      .find(fmt::format(" {} bytes", size)),
                  std::string::npos)
            << size;
}

}  // namespace
}  // namespace skyloop
