#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>

#include "firmware/ublox/config/config_handler.hpp"
#include "receiver/protocol/ubx_cfg.hpp"
#include "run/scenario/board_files.hpp"

namespace skyloop {
namespace {

using firmware::BoardProfile;
using firmware::ConfigStore;
using firmware::LegacyAnswer;
using firmware::PortId;
using firmware::Verdict;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;

BoardProfile shipped_board(std::string_view name) {
    const std::vector<std::filesystem::path> folders{std::filesystem::path(SKYLOOP_SOURCE_DIR) / "boards"};
    return find_board(name, folders).value();
}

std::uint64_t factory_of(const BoardProfile& board, std::string_view name) {
    const auto values = firmware::factory_config(board);
    const auto* key = firmware::find_config_key(name);
    return key != nullptr && values.contains(key->id) ? values.at(key->id) : ~std::uint64_t{0};
}

bool sends(const BoardProfile& board, std::string_view name) {
    const auto& all = board.messages;
    return std::find(all.begin(), all.end(), firmware::find_output_message(name)->id) != all.end();
}

Verdict set_in_ram(const BoardProfile& board, std::initializer_list<std::pair<std::uint32_t, std::uint64_t>> pairs,
                   std::uint8_t version = 0) {
    ConfigStore store(firmware::factory_config(board));
    firmware::ValueConfig values(board, store);
    CfgValset message{.version = version, .layers = 1, .transaction = 0, .reserved = 0, .pairs = {}};
    for (const auto& [key, value] : pairs)
        message.pairs.push_back({key, value});
    return values.valset(encode_payload(message)).verdict;
}

std::string ublox_refusal(std::string_view text) {
    const auto board = read_board(text, "test.toml");
    return board ? "accepted" : board.error().message;
}

constexpr std::string_view every_ublox_key = R"(
personality = "ublox"
[identity]
generation = 10
software = "SW"
hardware = "HW"
extensions = ["PROTVER=34.10", "GPS"]
unique_id = "01 02 03 04 aB ff"
banner = ["one", "two"]
version_answers = ["$PAIR020,X"]
[timing]
boot_s = 1
first_epoch_s = 2
answer_s = 0.003
flash_write_s = 0.4
signal_restart_s = 0.5
latency_deviation_s = 0.006
cold_start_s = 30
warm_start_s = 20
hot_start_s = 3
[quirks]
value_config = "silence"
single_key_valget = true
hardware_reset_clears_battery = false
speed_change_answer = "at_old_speed"
answers_unknown_nmea = true
interference_monitor = true
voltage_control = true
leap_seconds = 18
[uart]
baud = 9600
bauds = [115200, 9600]
ports = ["usb", "uart1"]
[navigation]
dual_frequency = true
bands_together = true
first_band_alone = ["beidou"]
most_systems = 2
signal_conflicts = ["CFG-SIGNAL-GLO_ENA CFG-SIGNAL-BDS_ENA"]
least_measurement_period_ms = 40
[nmea]
speed_decimals = 2
course_decimals = 1
course_always = true
satellites_padded = false
dop_decimals = 1
station_field = "0000"
beidou_talker = "BD"
qzss_talker = "QZ"
unknown_date_is_1980 = true
[ubx]
messages = ["NAV-PVT", "GGA", "PUBX-00", "RTCM-1005"]
polled = ["MON-VER", "NAV-EOE"]
gnss_blocks = ["00 08 10 00 01 00 11 01", "060810000000 0103"]
gnss_channels_hardware = 32
gnss_channels_used = 31
gnss_supported = 15
gnss_simultaneous = 3
comms_output_port = true
galileo_words = 9
[ubx.legacy]
CFG-PRT = "apply"
CFG-GNSS = "refuse"
CFG-RATE = "ignore"
CFG-TP5 = "silence"
[config]
absent = ["CFG-TMODE-*", "*RTCM3X", "CFG-ANA-*MAX*", "CFG-RATE-TIMEREF"]
CFG-RATE-MEAS = 200
CFG-ITFM-ENABLE = false
CFG-NAVSPG-INFIL_MINELEV = -5
CFG-TP-DUTY_TP1 = 12.5
)";

TEST(BoardFileUblox, ReadsHowItSavesPower) {
    const auto board = read_board(R"(
personality = "ublox"
[power]
save_modes = true
backup = true
backup_needs_force = true
keeps_ram = true
banner = false
texts = ["$AWAKE"]
wake_s = 0.1
acquisition_s = 60
blind_acquisition_s = 9
search_margin_s = 2
download_s = 18
)",
                                  "mine.toml");
    ASSERT_TRUE(board) << board.error().message;
    const firmware::PowerAbility& p = board->power;
    EXPECT_TRUE(p.save_modes && p.backup && p.backup_needs_force && p.keeps_ram && !p.banner);
    EXPECT_THAT(p.texts, ElementsAre("$AWAKE"));
    const std::vector<Seconds> times{p.wake, p.acquisition, p.blind_acquisition, p.search_margin, p.download};
    EXPECT_EQ(times, (std::vector<Seconds>{Seconds(0.1), Seconds(60), Seconds(9), Seconds(2), Seconds(18)}));
    EXPECT_THAT(ublox_refusal("personality = \"ublox\"\n[power]\nwake_s = -1\n"), HasSubstr("test.toml:3"));
}

TEST(BoardFileUblox, ShippedBoardsSavePowerAsTheirMakersSay) {
    for (const std::string_view name : {"ublox-6", "ublox-m8", "ublox-m9", "ublox-m10"})
        EXPECT_TRUE(shipped_board(name).power.save_modes && shipped_board(name).power.backup) << name;
    const firmware::PowerAbility f9p = shipped_board("ublox-f9p").power;
    EXPECT_TRUE(f9p.backup && !f9p.save_modes);
    EXPECT_TRUE(shipped_board("ublox-m10").power.backup_needs_force);
    EXPECT_FALSE(shipped_board("nmea-generic").power.backup);
}

TEST(BoardFileUblox, ReadsWhoTheReceiverIsAndItsTimes) {
    const auto board = read_board(every_ublox_key, "mine.toml");
    ASSERT_TRUE(board) << board.error().message;
    EXPECT_EQ(board->maker, firmware::MakerKind::ublox);
    EXPECT_EQ(board->identity.generation, 10);
    EXPECT_EQ(board->identity.software, "SW");
    EXPECT_EQ(board->identity.hardware, "HW");
    EXPECT_THAT(board->identity.extensions, ElementsAre("PROTVER=34.10", "GPS"));
    EXPECT_THAT(board->identity.unique_id, ElementsAre(1, 2, 3, 4, 0xAB, 0xFF));
    EXPECT_THAT(board->identity.banner, ElementsAre("one", "two"));
    EXPECT_THAT(board->identity.version_answers, ElementsAre("$PAIR020,X"));
    const firmware::Timing& t = board->timing;
    const std::vector<Seconds> times{t.boot,        t.first_epoch,    t.answer,
                                     t.flash_write, t.signal_restart, t.latency_deviation,
                                     t.cold_start,  t.warm_start,     t.hot_start};
    EXPECT_EQ(times, (std::vector<Seconds>{Seconds(1), Seconds(2), Seconds(0.003), Seconds(0.4), Seconds(0.5),
                                           Seconds(0.006), Seconds(30), Seconds(20), Seconds(3)}));
    EXPECT_EQ(board->quirks.value_config, firmware::ValueConfigSupport::silence);
    EXPECT_TRUE(board->quirks.single_key_valget);
    EXPECT_FALSE(board->quirks.hardware_reset_clears_battery);
    EXPECT_EQ(board->quirks.speed_change, firmware::SpeedChangeAnswer::at_old_speed);
    EXPECT_TRUE(board->quirks.answers_unknown_nmea);
    EXPECT_TRUE(board->quirks.default_interference_monitor);
    EXPECT_TRUE(board->quirks.voltage_control);
    EXPECT_EQ(board->quirks.leap_seconds, 18);
}

TEST(BoardFileUblox, ReadsPortsSignalsAndStyle) {
    const BoardProfile board = read_board(every_ublox_key, "mine.toml").value();
    EXPECT_THAT(board.bauds, ElementsAre(9600, 115200));
    EXPECT_THAT(board.ports, ElementsAre(PortId::uart1, PortId::usb));
    EXPECT_TRUE(board.dual_frequency);
    EXPECT_TRUE(board.bands_together);
    EXPECT_THAT(board.first_band_alone, ElementsAre(Constellation::beidou));
    EXPECT_EQ(board.most_systems, 2);
    EXPECT_THAT(board.signal_conflicts, ElementsAre(ElementsAre(0x10310022, 0x10310025)));
    EXPECT_EQ(board.least_measurement_period_ms, 40);
    EXPECT_EQ(board.style.speed_decimals, 2);
    EXPECT_EQ(board.style.course_decimals, 1);
    EXPECT_TRUE(board.style.course_always);
    EXPECT_FALSE(board.style.satellites_padded);
    EXPECT_EQ(board.style.dop_decimals, 1);
    EXPECT_EQ(board.style.station_field, "0000");
    EXPECT_EQ(board.style.beidou_talker, "BD");
    EXPECT_EQ(board.style.qzss_talker, "QZ");
    EXPECT_TRUE(board.style.unknown_date_is_1980);
}

TEST(BoardFileUblox, ReadsMessagesAndConfiguration) {
    const BoardProfile board = read_board(every_ublox_key, "mine.toml").value();
    EXPECT_THAT(board.messages, ElementsAre(UbxMessageId{0x01, 0x07}, UbxMessageId{0xF0, 0x00},
                                            UbxMessageId{0xF1, 0x00}, UbxMessageId{0xF5, 0x05}));
    EXPECT_THAT(board.polled, ElementsAre(UbxMessageId{0x01, 0x61}, UbxMessageId{0x0A, 0x04}));
    ASSERT_EQ(board.gnss_blocks.size(), 2U);
    EXPECT_EQ(board.gnss_blocks[0].flags, 0x01110001U);
    EXPECT_EQ(board.gnss_blocks[1].gnss_id, 6);
    EXPECT_EQ(board.gnss_blocks[1].reserved_channels, 8);
    EXPECT_EQ(board.gnss_blocks[1].max_channels, 0x10);
    EXPECT_EQ(board.gnss_blocks[1].flags, 0x03010000U);
    EXPECT_EQ(board.gnss_channels_hardware, 32);
    EXPECT_EQ(board.gnss_channels_used, 31);
    EXPECT_EQ(board.gnss_supported, 15);
    EXPECT_EQ(board.gnss_simultaneous, 3);
    EXPECT_TRUE(board.comms_output_port);
    EXPECT_EQ(board.galileo_words, 9U);
    const auto legacy = [&board](std::uint8_t id) { return board.legacy.at({0x06, id}); };
    EXPECT_EQ(board.legacy.size(), 4U);
    EXPECT_EQ(legacy(0x00), LegacyAnswer::apply);
    EXPECT_EQ(legacy(0x3E), LegacyAnswer::refuse);
    EXPECT_EQ(legacy(0x08), LegacyAnswer::ignore);
    EXPECT_EQ(legacy(0x31), LegacyAnswer::silence);
    EXPECT_EQ(board.config,
              (std::map<std::uint32_t, std::uint64_t>{
                  {0x10410000 | 0x0D, 0}, {0x201100A4, 0xFB}, {0x30210001, 200}, {0x5005002A, 0x4029'0000'0000'0000}}));
    const auto absent = [&board](std::string_view name) {
        return board.absent_keys.contains(firmware::find_config_key(name)->id);
    };
    EXPECT_TRUE(absent("CFG-TMODE-MODE"));
    EXPECT_TRUE(absent("CFG-UART1INPROT-RTCM3X"));
    EXPECT_TRUE(absent("CFG-ANA-ORBMAXERR"));
    EXPECT_TRUE(absent("CFG-RATE-TIMEREF"));
    EXPECT_FALSE(absent("CFG-ANA-USE_ANA"));
    EXPECT_FALSE(absent("CFG-RATE-MEAS"));
    EXPECT_FALSE(absent("CFG-UART1INPROT-UBX"));
}

// On boards without a list of items a rate for what they cannot send would be taken, and nothing would come.
TEST(BoardFileUblox, EveryMessageThatABoardSendsHasARate) {
    for (const auto& entry :
         std::filesystem::directory_iterator(std::string(SKYLOOP_SOURCE_DIR) + "/boards/receivers")) {
        const BoardProfile board = shipped_board(entry.path().stem().string());
        if (board.maker != firmware::MakerKind::ublox) continue;
        const firmware::ConfigValues items = firmware::factory_config(board);
        for (const firmware::OutputMessage& message : firmware::output_messages())
            for (const PortId port : board.ports) {
                const std::uint32_t rate = *firmware::rate_key(message.id, port);
                if (sends(board, message.name) || board.items_of == nullptr || !firmware::is_of_ublox(rate)) {
                    EXPECT_EQ(items.contains(rate), sends(board, message.name)) << board.name << ": " << message.name;
                }
            }
    }
}

TEST(BoardFileUblox, RefusesTheRateOfAMessageThatItDoesNotSend) {
    EXPECT_THAT(ublox_refusal("personality = \"ublox\"\n[ubx]\nmessages = [\"GGA\"]\n"
                              "[config]\nCFG-MSGOUT-UBX_NAV_PVT_UART1 = 1"),
                HasSubstr("is set, and is among the items that the board does not have"));
    constexpr std::uint32_t rawx_on_uart1 = 0x209102A5, relposned_on_uart1 = 0x2091008E;
    for (const std::uint32_t key : {rawx_on_uart1, relposned_on_uart1}) {
        EXPECT_FALSE(firmware::factory_config(shipped_board("ublox-m8")).contains(key));
        EXPECT_TRUE(firmware::factory_config(shipped_board("ublox-f9p")).contains(key));
    }
}

TEST(BoardFileUblox, RefusesUnknownNamesWithTheNearest) {
    EXPECT_EQ(
        ublox_refusal("[ubx]\nmessages = [\"GGA\", \"NAV-PTV\"]"),
        "test.toml:2:20: ubx.messages: holds 'NAV-PTV'; expected a list of messages by name, such as NAV-PVT, GGA "
        "or RTCM-1005; did you mean 'NAV-PVT'?");
    EXPECT_THAT(ublox_refusal("[ubx]\nmessages = [\"GGA\", \"GGA\"]"), HasSubstr("holds 'GGA' twice"));
    EXPECT_THAT(ublox_refusal("[ubx]\npolled = [\"MON-VRE\"]"), HasSubstr("did you mean 'MON-VER'?"));
    EXPECT_THAT(ublox_refusal("[ubx.legacy]\nCFG-GNS = \"apply\""),
                HasSubstr("test.toml:2:1: ubx.legacy.CFG-GNS: unknown key; did you mean 'CFG-GNSS'?"));
    EXPECT_THAT(ublox_refusal("[ubx.legacy]\nCFG-GNSS = \"nak\""),
                HasSubstr("expected one of apply ignore refuse silence"));
    EXPECT_EQ(ublox_refusal("personality = \"ublox\"\n[config]\nCFG-RATE-MES = 1"),
              "test.toml:3:16: config.CFG-RATE-MES: is no configuration item; did you mean 'CFG-RATE-MEAS'?");
    EXPECT_THAT(
        ublox_refusal("[config]\nabsent = [\"CFG-TMOD-MODE\"]"),
        HasSubstr("holds 'CFG-TMOD-MODE', which no configuration item is called; did you mean 'CFG-TMODE-MODE'?"));
    EXPECT_THAT(ublox_refusal("[navigation]\nsignal_conflicts = [\"CFG-RATE-MEAS\"]"),
                HasSubstr("holds 'CFG-RATE-MEAS', which no item of CFG-SIGNAL is called"));
    EXPECT_THAT(ublox_refusal("personality = \"unlox\""), HasSubstr("did you mean 'ublox'?"));
    EXPECT_THAT(ublox_refusal("[uart]\nports = [\"uart4\"]"), HasSubstr("expected a list of some of i2c uart1"));
    EXPECT_THAT(ublox_refusal("personality = \"ublox\"\n[uart]\nports = [\"uart3\"]"),
                HasSubstr("has uart3, which no u-blox receiver has"));
}

TEST(BoardFileUblox, RefusesValuesThatCannotBe) {
    EXPECT_THAT(ublox_refusal("[config]\nCFG-RATE-MEAS = 70000"),
                HasSubstr("test.toml:2:17: config.CFG-RATE-MEAS: is 70000; expected a whole number from 0 to 65535"));
    EXPECT_THAT(ublox_refusal("[config]\nCFG-NAVSPG-INFIL_MINELEV = -129"), HasSubstr("from -128 to 127"));
    EXPECT_THAT(ublox_refusal("[config]\nCFG-NAVSPG-DYNMODEL = 1"),
                HasSubstr("is 1, which the receiver itself would refuse"));
    EXPECT_THAT(ublox_refusal("[config]\nabsent = [\"CFG-RATE-*\"]\nCFG-RATE-NAV = 1"),
                HasSubstr("is set, and is among the items that the board does not have"));
    EXPECT_THAT(ublox_refusal("[uart]\nbaud = 9600\nbauds = [115200]"),
                HasSubstr("uart.bauds: does not hold uart.baud, 9600"));
    EXPECT_THAT(ublox_refusal("[uart]\nbauds = [100]"),
                HasSubstr("holds 100; expected a list, each entry a whole number from 1200 to 8000000"));
    EXPECT_THAT(ublox_refusal("[identity]\nunique_id = \"01 02 03\""),
                HasSubstr("expected five or six bytes in hexadecimal digits"));
    EXPECT_THAT(ublox_refusal("[identity]\nunique_id = \"01 02 03 04 5\""), HasSubstr("is '01 02 03 04 5'"));
    EXPECT_THAT(ublox_refusal("[identity]\nextensions = [\"0123456789012345678901234567890\"]"),
                HasSubstr("expected at most 30 characters"));
    EXPECT_THAT(ublox_refusal("[ubx]\ngnss_blocks = [\"00 08\"]"), HasSubstr("expected eight bytes in hexadecimal"));
    EXPECT_THAT(ublox_refusal("personality = \"ublox\"\n[navigation]\nconstellations = [\"sbas\"]"),
                HasSubstr("the factory settings do not go together"));
    EXPECT_THAT(ublox_refusal("personality = \"ublox\"\n[navigation]\nmax_rate_hz = 100\ndefault_rate_hz = 100"),
                HasSubstr("gives CFG-RATE-MEAS the factory value 10, which the receiver itself would refuse"));
}

TEST(BoardFileUblox, WithoutAListABoardSendsItsSentences) {
    const BoardProfile board = read_board("", "plain.toml").value();
    ASSERT_EQ(board.messages.size(), std::size(firmware::nmea_sentence_names));
    EXPECT_EQ(board.messages.front(), (UbxMessageId{0xF0, 0x04}));
    EXPECT_THAT(board.ports, ElementsAre(PortId::uart1));
}

// RECEIVER.md 2.1.
TEST(ShippedBoards, SayWhoTheyAre) {
    EXPECT_EQ(shipped_board("ublox-m8").identity.hardware, "00080000");
    EXPECT_EQ(shipped_board("ublox-m9").identity.software, "EXT CORE 4.04 (7f89f7)");
    EXPECT_EQ(shipped_board("ublox-m10").identity.unique_id.size(), 6U);
    EXPECT_EQ(shipped_board("ublox-6").identity.hardware, "00040007");
    EXPECT_THAT(shipped_board("ublox-f9p").identity.extensions,
                ElementsAre("ROM BASE 0x118B2060", "FWVER=HPG 1.32", "PROTVER=27.31", "MOD=ZED-F9P", "GPS;GLO;GAL;BDS",
                            "SBAS;QZSS"));
}

// RECEIVER.md 2.3.
TEST(ShippedBoards, SendWhatTheirGenerationHas) {
    const BoardProfile m6 = shipped_board("ublox-6"), m8 = shipped_board("ublox-m8"), m9 = shipped_board("ublox-m9"),
                       m10 = shipped_board("ublox-m10"), f9p = shipped_board("ublox-f9p");
    EXPECT_FALSE(sends(m6, "NAV-PVT"));
    for (const BoardProfile& board : {m8, m9, m10, f9p})
        EXPECT_TRUE(sends(board, "NAV-PVT")) << board.name;
    EXPECT_TRUE(sends(m6, "NAV-SOL") && sends(m8, "NAV-SOL") && !sends(m9, "NAV-SOL") && !sends(f9p, "NAV-SOL"));
    EXPECT_TRUE(sends(f9p, "NAV-RELPOSNED") && !sends(m9, "NAV-RELPOSNED") && !sends(m8, "NAV-RELPOSNED"));
    EXPECT_TRUE(sends(f9p, "RXM-RAWX") && !sends(m8, "RXM-RAWX") && !sends(m10, "RXM-RAWX"));
    EXPECT_TRUE(sends(m9, "NAV-SIG") && sends(m10, "NAV-SIG") && !sends(m8, "NAV-SIG"));
    EXPECT_TRUE(sends(m10, "NAV-PL") && !sends(m9, "NAV-PL"));
}

// RECEIVER.md 4.6.
TEST(ShippedBoards, EndAnEpochWithItsMark) {
    const auto place = [](const BoardProfile& board, std::string_view name) {
        const auto& all = board.messages;
        return std::find(all.begin(), all.end(), firmware::find_output_message(name)->id) - all.begin();
    };
    for (const char* name : {"ublox-m8", "ublox-m9", "ublox-m10", "ublox-f10", "ublox-f9p"}) {
        const BoardProfile board = shipped_board(name);
        for (const UbxMessageId message : board.messages) {
            const bool navigation = message.message_class == 0x01 || message.message_class >= 0xF0;
            const bool station = message == UbxMessageId{0xF5, 0x05} || message == UbxMessageId{0xF5, 0xE6};
            if (!navigation || station) continue;
            EXPECT_LE(place(board, firmware::find_output_message(message)->name), place(board, "NAV-EOE")) << name;
        }
        EXPECT_LT(place(board, "NAV-PVT"), place(board, "RMC"));
        EXPECT_LT(place(board, "RMC"), place(board, "GSV"));
    }
    EXPECT_LT(place(shipped_board("ublox-m8"), "NAV-SAT"), place(shipped_board("ublox-m8"), "RMC"));
    EXPECT_GT(place(shipped_board("ublox-f9p"), "NAV-SAT"), place(shipped_board("ublox-f9p"), "GLL"));
}

// RECEIVER.md 2.4.
TEST(ShippedBoards, HaveTheFactoryConfigurationOfTheirFirmware) {
    const BoardProfile m8 = shipped_board("ublox-m8"), m9 = shipped_board("ublox-m9"), m10 = shipped_board("ublox-m10"),
                       f9p = shipped_board("ublox-f9p");
    EXPECT_EQ(factory_of(m8, "CFG-NAVSPG-WKNROLLOVER"), 1867U);
    EXPECT_EQ(factory_of(m9, "CFG-NAVSPG-WKNROLLOVER"), 2117U);
    EXPECT_EQ(factory_of(m10, "CFG-NAVSPG-WKNROLLOVER"), 2139U);
    EXPECT_EQ(factory_of(f9p, "CFG-NAVSPG-WKNROLLOVER"), 2208U);
    EXPECT_EQ(factory_of(m8, "CFG-SBAS-PRNSCANMASK"), 0x851U);
    EXPECT_EQ(factory_of(m10, "CFG-SBAS-PRNSCANMASK"), 0x72BC8U);
    EXPECT_EQ(factory_of(m8, "CFG-SIGNAL-GAL_ENA"), 0U);
    EXPECT_EQ(factory_of(m10, "CFG-SIGNAL-GLO_ENA"), 0U);
    EXPECT_EQ(factory_of(m10, "CFG-SIGNAL-QZSS_L1S_ENA"), 1U);
    // Dumps of HPG 1.32 and 1.51 have it at 0; a NEO-M9N refuses it (PX4-GPSDrivers, pull request 225).
    EXPECT_EQ(factory_of(f9p, "CFG-SIGNAL-QZSS_L1S_ENA"), 0U);
    EXPECT_EQ(factory_of(m9, "CFG-SIGNAL-QZSS_L1S_ENA"), ~std::uint64_t{0}) << "absent";
    EXPECT_EQ(factory_of(m10, "CFG-SIGNAL-BDS_B1C_ENA"), 0U);
    EXPECT_EQ(factory_of(f9p, "CFG-SIGNAL-GPS_L2C_ENA"), 1U);
    EXPECT_EQ(factory_of(f9p, "CFG-NAVSPG-INFIL_MINELEV"), 10U);
    EXPECT_EQ(factory_of(f9p, "CFG-UART2INPROT-UBX"), 1U);
    EXPECT_EQ(factory_of(m10, "CFG-NMEA-PROTVER"), 42U);
    EXPECT_EQ(factory_of(m8, "CFG-NMEA-PROTVER"), 40U);
    EXPECT_EQ(f9p.gnss_blocks.size(), 6U);
    EXPECT_EQ(f9p.gnss_blocks[2].flags, 0x01210001U);
    EXPECT_EQ(m8.gnss_blocks.size(), 7U);
    EXPECT_THAT(m10.gnss_blocks, IsEmpty());
    EXPECT_EQ(m8.legacy.at({0x06, 0x3E}), LegacyAnswer::apply);
    EXPECT_EQ(m10.legacy.at({0x06, 0x3E}), LegacyAnswer::refuse);
    EXPECT_EQ(shipped_board("ublox-6").legacy.count({0x06, 0x3E}), 0U);
}

// RECEIVER.md 2.4; a real one NAKs BeiDou beside GPS and GLONASS (philrandal/gpsctl #5), whose third band it has no
// room for, and has L1 alone.
TEST(ShippedBoards, AnM8ReceivesTwoOfItsThreeBandsAndNoSecondSignals) {
    const BoardProfile m8 = shipped_board("ublox-m8");
    const auto answer = [&m8](const CfgGnss& message) {
        ConfigStore store(firmware::factory_config(m8));
        firmware::LegacyConfig legacy(m8, store);
        return legacy.handle(CfgGnss::message_id, encode_payload(message), PortId::uart1).verdict;
    };
    const auto systems = [](std::vector<CfgGnssItem> items) {
        CfgGnss message;
        message.num_trk_ch_use = 32;
        message.systems = std::move(items);
        return message;
    };
    const CfgGnssItem no_gps{0, 8, 16, 0, 0x01010000}, no_glonass{6, 8, 14, 0, 0x01010000},
        beidou{3, 8, 16, 0, 0x01010001}, galileo{2, 4, 8, 0, 0x01010001};
    EXPECT_EQ(answer(systems({beidou})), Verdict::refuse) << "beside GPS and GLONASS";
    EXPECT_EQ(answer(systems({galileo, no_gps, beidou})), Verdict::refuse) << "beside Galileo and GLONASS";
    EXPECT_EQ(answer(systems({beidou, no_gps})), Verdict::acknowledge);
    EXPECT_EQ(answer(systems({beidou, no_glonass})), Verdict::acknowledge);
    EXPECT_EQ(answer(systems({galileo})), Verdict::acknowledge);
    EXPECT_EQ(answer(systems({{0, 8, 16, 0, 0x01100001}})), Verdict::refuse) << "L2C alone";
    ConfigStore store(firmware::factory_config(m8));
    firmware::LegacyConfig legacy(m8, store);
    const CfgGnss both = systems({{0, 8, 16, 0, 0x01110001}});
    EXPECT_EQ(legacy.handle(CfgGnss::message_id, encode_payload(both), PortId::uart1).verdict, Verdict::acknowledge);
    const auto told = decode_payload<CfgGnss>(
        parse_frame(legacy.handle(CfgGnss::message_id, {}, PortId::uart1).answers.at(0))->payload);
    EXPECT_EQ(told->systems.at(0).flags, 0x01010001U) << "L1 with L2C is L1";
    for (const char* name : {"CFG-SIGNAL-GPS_L2C_ENA", "CFG-SIGNAL-GAL_E5B_ENA", "CFG-SIGNAL-BDS_B2_ENA",
                             "CFG-SIGNAL-GLO_L2_ENA", "CFG-SIGNAL-QZSS_L5_ENA", "CFG-SIGNAL-NAVIC_ENA"})
        EXPECT_EQ(factory_of(m8, name), ~std::uint64_t{0}) << name << " is none of its items";
}

// SPG L1L5 6.00: GPS, Galileo and BeiDou, whose L1 is B1C alone; no legacy configuration (RECEIVER.md 4.1).
TEST(ShippedBoards, TheF10IsAnM10WithL5AndWithoutGlonass) {
    const BoardProfile f10 = shipped_board("ublox-f10");
    for (const char* name : {"CFG-SIGNAL-GPS_L5_ENA", "CFG-SIGNAL-GAL_E5A_ENA", "CFG-SIGNAL-BDS_B2A_ENA",
                             "CFG-SIGNAL-QZSS_L5_ENA", "CFG-SIGNAL-BDS_B1C_ENA"})
        EXPECT_EQ(factory_of(f10, name), 1U) << name;
    EXPECT_EQ(factory_of(f10, "CFG-SIGNAL-HEALTH_L5"), 0U);
    EXPECT_EQ(factory_of(f10, "CFG-SIGNAL-NAVIC_ENA"), 0U);
    // PX4's and a user's way to override the health of L5, and a question for GLONASS (satpulse #71).
    EXPECT_EQ(set_in_ram(f10, {{0x10320001, 1}}), Verdict::refuse) << "by version 0 (PX4-GPSDrivers #181)";
    EXPECT_EQ(set_in_ram(f10, {{0x10320001, 1}}, 1), Verdict::acknowledge);
    for (const char* board : {"ublox-f9p-15b", "ublox-x20p"})
        EXPECT_EQ(set_in_ram(shipped_board(board), {{0x10320001, 1}}), Verdict::acknowledge) << board;
    EXPECT_EQ(set_in_ram(f10, {{0x10310025, 0}}), Verdict::refuse);
    EXPECT_EQ(f10.legacy.size(), 1U);
    for (const char* port : {"I2C", "UART1", "SPI"})
        EXPECT_EQ(factory_of(f10, std::string("CFG-MSGOUT-UBX_RXM_RAWX_") + port), 0U) << "ArduPilot asks for it";
    EXPECT_FALSE(sends(f10, "RXM-RAWX"));
    EXPECT_EQ(factory_of(f10, "CFG-SIGNAL-BDS_B1_ENA"), 0U);
    EXPECT_EQ(set_in_ram(f10, {{0x1031000D, 1}}), Verdict::refuse) << "B1I, though it has the item";
    EXPECT_EQ(set_in_ram(f10, {{0x10310022, 0}, {0x1031000D, 0}}), Verdict::acknowledge);
    // GPS L1 and L5, E1 and E5a, B1C and B2a, QZSS L1 and L5.
    constexpr std::uint32_t bands[][3] = {{0x1031001F, 0x10310001, 0x10310004},
                                          {0x10310021, 0x10310007, 0x10310009},
                                          {0x10310022, 0x1031000F, 0x10310028},
                                          {0x10310024, 0x10310012, 0x10310017}};
    for (const auto& [system, upper, lower] : bands) {
        EXPECT_EQ(set_in_ram(f10, {{upper, 0}}), Verdict::refuse) << upper;
        EXPECT_EQ(set_in_ram(f10, {{lower, 0}}), Verdict::refuse) << lower;
        EXPECT_EQ(set_in_ram(f10, {{upper, 0}, {lower, 0}}), Verdict::acknowledge) << system;
        EXPECT_EQ(set_in_ram(f10, {{system, 0}, {lower, 0}}), Verdict::acknowledge) << system;
    }
    EXPECT_TRUE(f10.comms_output_port && !shipped_board("ublox-f9p").comms_output_port);
}

// The batches of PX4, INAV, ArduPilot and Betaflight (RECEIVER.md 6.1 to 6.4).
TEST(ShippedBoards, TakeWhatTheirClientsSet) {
    const BoardProfile m8 = shipped_board("ublox-m8"), m9 = shipped_board("ublox-m9"), m10 = shipped_board("ublox-m10"),
                       f10 = shipped_board("ublox-f10"), f9p = shipped_board("ublox-f9p");
    for (const BoardProfile& board : {m9, m10, f10, f9p}) {
        EXPECT_EQ(set_in_ram(board, {{0x20520002, 1},
                                     {0x20520003, 0},
                                     {0x20520004, 0},
                                     {0x10730001, 1},
                                     {0x10730002, 0},
                                     {0x10740001, 1},
                                     {0x10740002, 0}}),
                  Verdict::acknowledge);
        EXPECT_EQ(set_in_ram(board, {{0x20110011, 3},
                                     {0x2011001C, 3},
                                     {0x20110021, 7},
                                     {0x10220001, 0},
                                     {0x10220002, 0},
                                     {0x10220003, 0},
                                     {0x10220004, 0},
                                     {0x30210001, 125},
                                     {0x30210002, 1},
                                     {0x20210003, 0}}),
                  Verdict::acknowledge);
        EXPECT_EQ(set_in_ram(board, {{0x1041000D, 1}}), Verdict::acknowledge);
        EXPECT_EQ(set_in_ram(board, {{0x40520001, 115200}}), Verdict::acknowledge);
        EXPECT_EQ(set_in_ram(board, {{0x20910007, 1}, {0x20910016, 1}, {0x20910346, 1}, {0x2091035A, 1}}),
                  Verdict::acknowledge);
    }
    for (const BoardProfile& board : {m9, f9p}) {
        EXPECT_EQ(
            set_in_ram(
                board,
                {{0x10730004, 1}, {0x10770001, 1}, {0x10770004, 1}, {0x10770002, 0}, {0x10780001, 1}, {0x10780002, 0}}),
            Verdict::acknowledge);
        EXPECT_EQ(set_in_ram(board, {{0x20910269, 1}, {0x2091026B, 1}}), Verdict::acknowledge);
    }
    EXPECT_EQ(set_in_ram(f9p, {{0x20140011, 3}, {0x20910034, 1}, {0x20910036, 1}, {0x10720004, 1}}),
              Verdict::acknowledge);
    EXPECT_EQ(set_in_ram(m9, {{0x20140011, 3}}), Verdict::refuse);
    EXPECT_EQ(set_in_ram(m10, {{0x20910009, 1}}), Verdict::refuse);  // it has no USB
    EXPECT_EQ(set_in_ram(m10, {{0x10310020, 1},
                               {0x10310005, 1},
                               {0x10310021, 1},
                               {0x10310007, 1},
                               {0x10310022, 1},
                               {0x1031000D, 0},
                               {0x1031000F, 1},
                               {0x10310024, 1},
                               {0x10310012, 1},
                               {0x10310014, 1},
                               {0x10310025, 1},
                               {0x10310018, 1}}),
              Verdict::acknowledge);
    EXPECT_EQ(set_in_ram(m8, {{0x10730001, 1}}), Verdict::refuse);
}

}  // namespace
}  // namespace skyloop
