#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <bit>

#include "config_support.hpp"
#include "firmware/ublox/config/config_handler.hpp"

namespace skyloop::firmware {
namespace {

std::uint64_t factory_value(const BoardProfile& board, std::string_view name) {
    return factory_config(board).at(find_config_key(name)->id);
}

bool factory_has(const BoardProfile& board, std::string_view name) {
    return factory_config(board).contains(find_config_key(name)->id);
}

TEST(FactoryConfig, HoldsEveryItemOfAWholeBoard) {
    const ConfigValues values = factory_config(whole_board());
    EXPECT_EQ(values.size(), config_keys().size());
    EXPECT_TRUE(is_consistent(whole_board(), values));
}

TEST(FactoryConfig, FollowsTheBoard) {
    BoardProfile board = whole_board();
    board.default_rate_hz = 5;
    board.elevation_mask = Angle::degrees(12);
    board.nmea_version = NmeaVersion::v4_11;
    board.satellite_numbering = NmeaNumbering::extended;
    board.main_talker = "GN";
    board.quirks.default_interference_monitor = true;
    board.quirks.voltage_control = true;
    EXPECT_EQ(factory_value(board, "CFG-UART1-BAUDRATE"), 38400U);
    EXPECT_EQ(factory_value(board, "CFG-RATE-MEAS"), 200U);
    EXPECT_EQ(factory_value(board, "CFG-NAVSPG-INFIL_MINELEV"), 12U);
    EXPECT_EQ(factory_value(board, "CFG-NMEA-PROTVER"), 42U);
    EXPECT_EQ(factory_value(board, "CFG-NMEA-SVNUMBERING"), 1U);
    EXPECT_EQ(factory_value(board, "CFG-NMEA-MAINTALKERID"), 3U);
    EXPECT_EQ(factory_value(board, "CFG-ITFM-ENABLE"), 1U);
    EXPECT_EQ(factory_value(board, "CFG-HW-ANT_CFG_VOLTCTRL"), 1U);
    EXPECT_EQ(factory_value(board, "CFG-SIGNAL-GPS_ENA"), 1U);
    EXPECT_EQ(factory_value(board, "CFG-SIGNAL-GLO_ENA"), 0U);
    EXPECT_EQ(factory_value(board, "CFG-SIGNAL-GLO_L1_ENA"), 1U);  // so that a client need only enable the system
}

TEST(FactoryConfig, EnablesSecondSignalsOfADualFrequencyBoard) {
    BoardProfile board = whole_board();
    EXPECT_EQ(factory_value(board, "CFG-SIGNAL-GAL_E5B_ENA"), 0U);
    board.dual_frequency = true;
    for (const char* name : {"GPS_L2C", "GAL_E5B", "BDS_B2", "QZSS_L2C", "GLO_L2"})
        EXPECT_EQ(factory_value(board, std::string("CFG-SIGNAL-") + name + "_ENA"), 1U) << name;
}

TEST(FactoryConfig, EnablesThemInTheBandOfTheBoard) {
    BoardProfile board = whole_board();
    board.dual_frequency = true;
    board.second_band = SecondBand::l5;
    for (const char* name : {"GPS_L5", "GAL_E5A", "BDS_B2A", "QZSS_L5"})
        EXPECT_EQ(factory_value(board, std::string("CFG-SIGNAL-") + name + "_ENA"), 1U) << name;
    for (const char* name : {"GPS_L2C", "GAL_E5B", "BDS_B2", "QZSS_L2C", "GLO_L2"})
        EXPECT_EQ(factory_value(board, std::string("CFG-SIGNAL-") + name + "_ENA"), 0U) << name;
}

TEST(FactoryConfig, SendsTheBoardsSentencesOnEveryPort) {
    const BoardProfile board = whole_board();
    for (const char* port : {"I2C", "UART1", "UART2", "USB", "SPI"}) {
        EXPECT_EQ(factory_value(board, std::string("CFG-MSGOUT-NMEA_ID_GGA_") + port), 1U);
        EXPECT_EQ(factory_value(board, std::string("CFG-MSGOUT-NMEA_ID_GSV_") + port), 5U);
        EXPECT_EQ(factory_value(board, std::string("CFG-MSGOUT-NMEA_ID_RMC_") + port), 0U);
    }
}

TEST(FactoryConfig, ThatOfTheBoardFileComesLast) {
    BoardProfile board = whole_board();
    board.config[key::rate_meas] = 250;
    board.config[0x20910007] = 1;
    EXPECT_EQ(factory_value(board, "CFG-RATE-MEAS"), 250U);
    EXPECT_EQ(factory_value(board, "CFG-MSGOUT-UBX_NAV_PVT_UART1"), 1U);
}

TEST(FactoryConfig, LeavesOutWhatTheBoardDoesNotHave) {
    BoardProfile board = whole_board();
    board.ports = {PortId::i2c, PortId::uart1, PortId::spi};
    board.absent_keys = {key::tmode_mode};
    board.config[key::tmode_mode] = 1;
    EXPECT_FALSE(factory_has(board, "CFG-TMODE-MODE"));
    for (const char* name :
         {"CFG-UART2-BAUDRATE", "CFG-UART2INPROT-UBX", "CFG-USBOUTPROT-NMEA", "CFG-USB-ENABLED", "CFG-INFMSG-UBX_USB",
          "CFG-INFMSG-NMEA_UART2", "CFG-MSGOUT-UBX_NAV_PVT_USB", "CFG-MSGOUT-NMEA_ID_GGA_UART2"})
        EXPECT_FALSE(factory_has(board, name)) << name;
    for (const char* name : {"CFG-UART1-BAUDRATE", "CFG-SPIOUTPROT-NMEA", "CFG-I2C-ADDRESS", "CFG-INFMSG-UBX_SPI",
                             "CFG-INFMSG-NMEA_I2C", "CFG-MSGOUT-UBX_NAV_PVT_SPI", "CFG-MSGOUT-NMEA_ID_GGA_UART1"})
        EXPECT_TRUE(factory_has(board, name)) << name;
}

TEST(ConfigRange, IsThatOfTheItem) {
    const BoardProfile board = whole_board();
    const auto takes = [&board](std::uint32_t key, std::uint64_t value) { return is_in_range(board, key, value); };
    EXPECT_TRUE(takes(key::navspg_dynmodel, 8));
    EXPECT_FALSE(takes(key::navspg_dynmodel, 1));
    EXPECT_FALSE(takes(key::navspg_dynmodel, 13));
    EXPECT_TRUE(takes(key::navspg_fixmode, 3));
    EXPECT_FALSE(takes(key::navspg_fixmode, 0));
    EXPECT_FALSE(takes(key::navspg_fixmode, 4));
    EXPECT_TRUE(takes(key::nmea_protver, 42));
    EXPECT_FALSE(takes(key::nmea_protver, 22));
    EXPECT_TRUE(takes(key::navspg_min_elev, 0xFB));   // -5 degrees
    EXPECT_FALSE(takes(key::navspg_min_elev, 0xA5));  // -91
    EXPECT_FALSE(takes(key::navspg_min_elev, 91));
    EXPECT_TRUE(takes(0x5005002A, std::bit_cast<std::uint64_t>(37.5)));
    EXPECT_FALSE(takes(0x5005002A, std::bit_cast<std::uint64_t>(100.5)));
    EXPECT_FALSE(takes(0x5005002A, std::bit_cast<std::uint64_t>(-1.0)));
    EXPECT_FALSE(takes(0x5005002A, 0x7FF8'0000'0000'0000));  // not a number
    EXPECT_FALSE(takes(key::rate_timeref, 6));
    EXPECT_TRUE(takes(0x20910007, 255));
    EXPECT_FALSE(takes(0x20910007, 256));  // more than its byte holds
    EXPECT_FALSE(takes(0x20990001, 0));    // no item
}

TEST(ConfigRange, IsThatOfTheBoard) {
    BoardProfile board = whole_board();
    EXPECT_TRUE(is_in_range(board, key::uart1_baudrate, 115200));
    EXPECT_FALSE(is_in_range(board, key::uart1_baudrate, 57600));
    board.bauds.clear();
    for (const std::uint64_t some : {1200U, 57600U, 8'000'000U})
        EXPECT_TRUE(is_in_range(board, key::uart2_baudrate, some)) << some;
    for (const std::uint64_t no_line_has : {0U, 6U, 1199U, 8'000'001U})
        EXPECT_FALSE(is_in_range(board, key::uart2_baudrate, no_line_has)) << no_line_has;
    BoardProfile other = board;
    other.nmea_version = NmeaVersion::v2_3;
    for (const int generation : {6, 8}) {
        other.identity.generation = generation;
        EXPECT_TRUE(is_in_range(other, key::nmea_protver, 21));
        EXPECT_EQ(is_in_range(other, key::nmea_protver, 40), generation == 8);
        EXPECT_TRUE(is_in_range(other, key::navspg_dynmodel, 8));
        EXPECT_EQ(is_in_range(other, key::navspg_dynmodel, 9), generation == 8) << "a wrist";
    }
    for (const std::uint32_t reference : {key::rate_timeref, 0x2005000CU, 0x20050017U})
        for (const int generation : {8, 9}) {
            other.identity.generation = generation;
            EXPECT_TRUE(is_in_range(other, reference, 4));
            EXPECT_EQ(is_in_range(other, reference, 5), generation == 9) << "NavIC's time";
        }
    other.identity.generation = 6;
    other.nmea_version = NmeaVersion::v4_0;
    EXPECT_TRUE(is_in_range(other, key::nmea_protver, 40)) << "as its factory has it";
    EXPECT_TRUE(is_in_range(board, key::rate_meas, 25));
    EXPECT_FALSE(is_in_range(board, key::rate_meas, 24));
    board.least_measurement_period_ms = 50;
    EXPECT_FALSE(is_in_range(board, key::rate_meas, 49));
    EXPECT_TRUE(is_in_range(board, key::rate_nav, 127));
    EXPECT_FALSE(is_in_range(board, key::rate_nav, 128));
    EXPECT_FALSE(is_in_range(board, key::rate_nav, 0));
    board.identity.generation = 8;
    EXPECT_TRUE(is_in_range(board, key::rate_nav, 128));
}

TEST(ConfigConsistency, NeedsASystemWithASignal) {
    const BoardProfile board = whole_board();
    const ConfigValues factory = factory_config(board);
    ConfigValues ram = factory;
    ram[gps_item] = ram[galileo_item] = 0;
    EXPECT_FALSE(is_consistent(board, ram));  // SBAS alone gives no position
    ram[glonass_item] = 1;
    EXPECT_TRUE(is_consistent(board, ram));
    ram[0x10310018] = 0;  // GLONASS without L1
    EXPECT_FALSE(is_consistent(board, ram));
    ram[0x1031001A] = 1;  // L2 alone does not do
    EXPECT_FALSE(is_consistent(board, ram));
    ram = factory;
    ram[beidou_item] = 1;
    ram[0x1031000D] = 0;  // B1I off, B1C on
    ram[0x1031000F] = 1;
    EXPECT_TRUE(is_consistent(board, ram));
}

TEST(ConfigConsistency, LetsSomeSystemsGoWithTheirFirstBandAlone) {
    constexpr std::uint32_t gps_l2c = 0x10310003, beidou_b1i = 0x1031000D, beidou_b2i = 0x1031000E;
    BoardProfile board = whole_board();
    board.dual_frequency = true;
    const ConfigValues both = factory_config(board);
    const auto stands = [&](ConfigValues changes) {
        ConfigValues ram = both;
        ram[beidou_item] = 1;
        for (const auto& [key, value] : changes)
            ram[key] = value;
        return is_consistent(board, ram);
    };
    EXPECT_TRUE(stands({{gps_l2c, 0}}));
    board.bands_together = true;
    board.first_band_alone = {Constellation::beidou};
    EXPECT_TRUE(stands({}));
    EXPECT_FALSE(stands({{gps_l2c, 0}}));
    EXPECT_TRUE(stands({{gps_l2c, 0}, {gps_item, 0}})) << "a system that is off";
    EXPECT_TRUE(stands({{beidou_b2i, 0}}));
    EXPECT_FALSE(stands({{beidou_b1i, 0}}));
}

TEST(ConfigConsistency, KnowsWhatTheFrontEndCannotDo) {
    BoardProfile board = whole_board();
    ConfigValues ram = factory_config(board);
    ram[glonass_item] = ram[beidou_item] = 1;
    EXPECT_TRUE(is_consistent(board, ram));
    board.most_systems = 3;
    EXPECT_FALSE(is_consistent(board, ram));
    ram[gps_item] = 0;
    EXPECT_TRUE(is_consistent(board, ram));
    board.signal_conflicts = {{galileo_item, beidou_item, glonass_item}};
    EXPECT_FALSE(is_consistent(board, ram));
    ram[galileo_item] = 0;
    EXPECT_TRUE(is_consistent(board, ram));
}

TEST(ConfigConsistency, CutsOnlyASupplyThatIsSwitched) {
    const BoardProfile board = whole_board();
    ConfigValues ram = factory_config(board);
    ram[key::ant_power_down] = 1;
    EXPECT_FALSE(is_consistent(board, ram));
    ram[key::ant_voltage_control] = 1;
    EXPECT_TRUE(is_consistent(board, ram));
}

}  // namespace
}  // namespace skyloop::firmware
