// What a scenario becomes, and what it is refused for.
#include "run/emulator/assembly.hpp"

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <functional>

#include "support/run_parts.hpp"
#include "unit/transport/temporary_folder.hpp"

namespace skyloop {
namespace {

using test::emulator_data;
using test::emulator_scenario;
using testing::AllOf;
using testing::Contains;
using testing::HasSubstr;
using testing::Not;
using testing::StartsWith;

RunMode virtual_mode() {
    RunMode mode;
    mode.virtual_time = true;
    mode.open_ports = false;
    mode.now = to_gps_time(2400, 0);
    return mode;
}

Assembly assembled(const std::string& text, const RunMode& mode = virtual_mode()) {
    auto assembly = assemble(emulator_scenario(text), emulator_data(), mode);
    EXPECT_TRUE(assembly) << assembly.error().message;
    return assembly ? std::move(*assembly) : Assembly{};
}

Error refusal(const std::string& text, const RunMode& mode = virtual_mode()) {
    const auto assembly = assemble(emulator_scenario(text), emulator_data(), mode);
    return assembly ? Error{ErrorCode::outside, "accepted"} : assembly.error();
}

TEST(Assembly, StartsAndEndsAsTheScenarioSays) {
    const Assembly endless = assembled("");
    EXPECT_EQ(endless.start, virtual_mode().now);
    EXPECT_FALSE(endless.end);
    const Assembly ending = assembled("[run]\nstart = 2024-03-05T12:00:00Z\nduration_s = 2.5");
    EXPECT_EQ(*ending.end - ending.start, std::chrono::milliseconds(2500));
    EXPECT_EQ(ending.emulator->now(), ending.start);
}

TEST(Assembly, UnknownBoardsAreUsageErrors) {
    const Error board = refusal("[[receiver]]\nboard = \"ublox-m7\"");
    EXPECT_EQ(board.code, ErrorCode::usage);
    EXPECT_THAT(board.message, HasSubstr("board 'ublox-m7' is not known"));
}

TEST(Assembly, KeysThatLeaveAReceiverThatRefusesEverySettingAreRefused) {
    const auto told = [](const std::string& board, const std::string& keys) {
        return refusal("[[receiver]]\nboard = \"" + board + "\"\n" + keys).message;
    };
    const auto four = "constellations = [\"gps\", \"galileo\", \"beidou\", \"glonass\"]";
    const auto systems = [](const std::string& board) {
        return StartsWith("test.toml:3:18: receiver.constellations: " + board + " itself would refuse these systems");
    };
    EXPECT_THAT(told("ublox-m8", four), systems("ublox-m8"));
    EXPECT_THAT(told("ublox-m10", four), systems("ublox-m10"));
    EXPECT_THAT(told("ublox-m8", "constellations = [\"gps\", \"glonass\", \"beidou\"]"), systems("ublox-m8"));
    EXPECT_THAT(told("ublox-m8", "constellations = [\"sbas\"]"), systems("ublox-m8"));
    EXPECT_EQ(told("ublox-m8", "baud = 921600"),
              "test.toml:3:8: receiver.baud: CFG-UART1-BAUDRATE is 921600, which ublox-m8 itself would refuse");
    EXPECT_THAT(told("ublox-m9", "baud = 1000000"), StartsWith("test.toml:3:8: receiver.baud: "));
    EXPECT_EQ(refusal("[[receiver]]\nbaud = 921600").code, ErrorCode::usage);
    for (const auto* board : {"ublox-m9", "ublox-f9p", "septentrio-sbf", "nmea-generic"})
        EXPECT_EQ(told(board, four), "accepted") << board;
    EXPECT_EQ(told("ublox-m8", "constellations = [\"gps\", \"galileo\", \"glonass\"]"), "accepted");
    EXPECT_EQ(told("ublox-m8", "baud = 460800"), "accepted");
    EXPECT_EQ(told("nmea-generic", "baud = 1000000"), "accepted") << "of a maker whose speeds are not known";
    for (const auto* board : {"ublox-6", "ublox-m8", "ublox-m9", "ublox-m10", "ublox-f10", "ublox-f9p"})
        for (const auto* keys : {"rate_hz = 100", "dual_frequency = true", "static_hold_mps = 100",
                                 "dynamic_model = \"airborne-4g\"", "constellations = [\"gps\"]"})
            EXPECT_EQ(told(board, keys), "accepted") << board << ": " << keys;
}

TEST(Assembly, WhatAKeyIsRefusedForHasItsPlaceInTheFile) {
    const auto told = [](const std::string& text) { return refusal(text).message; };
    EXPECT_THAT(told("[[receiver]]\nboard = \"ublox-m7\""),
                StartsWith("test.toml:2:9: receiver.board: board 'ublox-m7' is not known; did you mean "));
    EXPECT_THAT(told("[[receiver]]\n[[receiver]]\nport = \"foo:1\""),
                StartsWith("test.toml:3:8: receiver.port: port 'foo:1': no such kind of port"));
    EXPECT_THAT(told("[[receiver]]\npower = \"relay:x\""), StartsWith("test.toml:2:9: receiver.power: "));
    EXPECT_THAT(told("[trajectory]\nkind = \"live\"\nsource = \"udp-jsn:5000\""),
                AllOf(StartsWith("test.toml:3:10: trajectory.source: "), HasSubstr("udp-jsn")));
    EXPECT_THAT(told("[run]\nstart = 2024-03-05T12:00:00Z\n[[fault]]\nkind = \"outage\"\nat_utc = "
                     "2024-03-05T11:00:00Z"),
                StartsWith("test.toml:3:1: [[fault]] 'outage': at_utc is 2024-03-05T11:00:00.000Z"));
    EXPECT_THAT(told("[sky]\nrebase_navigation = true"),
                StartsWith("test.toml:2:21: sky.rebase_navigation: moves navigation data, but there is none"));
    const std::string header = "[model]\nname = \"baseline\"\n[atmosphere]\ntec_source = \"header\"\n";
    for (const char* receivers : {"", "[[receiver]]\n[[receiver]]\n"})
        EXPECT_THAT(told(header + receivers),
                    StartsWith("test.toml:4:14: atmosphere.tec_source: is 'header', and the navigation data has no "
                               "ionosphere coefficients"));
    Scenario by_option = emulator_scenario("[[receiver]]\nboard = \"ublox-m8\"");
    by_option.receivers[0].board = "ublox-m7";
    by_option.receivers[0].told_at.erase("board");
    EXPECT_THAT(assemble(by_option, emulator_data(), virtual_mode()).error().message,
                StartsWith("board 'ublox-m7' is not known"));
}

TEST(Assembly, TheScenarioChangesTheBoard) {
    const Assembly plain = assembled("");
    EXPECT_EQ(plain.emulator->receiver().baud(firmware::PortId::uart1), 9600U);
    EXPECT_EQ(plain.emulator->receiver().settings().navigation_period, std::chrono::seconds(1));
    const Assembly changed =
        assembled("[[receiver]]\nboard = \"ublox-m9\"\nrate_hz = 4\nbaud = 115200\nsentences = [\"ZDA\", \"RMC\"]");
    const firmware::Receiver& receiver = changed.emulator->receiver();
    EXPECT_EQ(receiver.board().name, "ublox-m9");
    EXPECT_EQ(receiver.baud(firmware::PortId::uart1), 115200U);
    EXPECT_EQ(receiver.settings().navigation_period, std::chrono::milliseconds(250));
    ASSERT_EQ(receiver.board().sentences.size(), 2U);
    EXPECT_EQ(receiver.board().sentences[0].sentence, firmware::NmeaSentence::zda);
    EXPECT_EQ(receiver.board().sentences[1].every_epochs, 1);
}

TEST(Assembly, AScenarioDelaysItsReceiver) {
    const double of_board = assembled("").emulator->receiver().board().solution_latency.value();
    EXPECT_NE(of_board, 0.2);
    const Assembly delayed = assembled("[[receiver]]\nlatency_s = 0.2");
    EXPECT_EQ(delayed.emulator->receiver().board().solution_latency.value(), 0.2);
}

TEST(Assembly, ARateAboveTheBoardsIsAWarning) {
    const Assembly fast = assembled("[[receiver]]\nboard = \"ublox-m8\"\nrate_hz = 50");
    EXPECT_THAT(fast.warnings, Contains(HasSubstr("50 Hz is more than ublox-m8 can do; it runs at 18 Hz")));
    EXPECT_EQ(fast.emulator->receiver().settings().navigation_period, std::chrono::milliseconds(56))
        << "whole milliseconds";
    EXPECT_THAT(assembled("[[receiver]]\nrate_hz = 10").warnings, Not(Contains(HasSubstr("Hz is more than"))));
}

TEST(Assembly, PassesTheScenariosWarningsOn) {
    EXPECT_THAT(
        assembled("[frame]\norigin = [46, 30, 0]\n[trajectory]\nkind = \"fixed\"\nat_level = [9000, 0, 0]").warnings,
        Contains(HasSubstr("beyond 4000 m")));
}

TEST(Assembly, WithoutAGeoidItWarnsAndGoesOn) {
    const auto assembly =
        assemble(emulator_scenario(""), DataFolders{{std::filesystem::path(SKYLOOP_SOURCE_DIR)}}, virtual_mode());
    ASSERT_TRUE(assembly) << assembly.error().message;
    EXPECT_EQ(assembly->geoid, nullptr);
    EXPECT_THAT(assembly->warnings, Contains(HasSubstr("heights above sea level are taken as heights above the")));
}

TEST(Assembly, TecFromTheHeaderNeedsAHeader) {
    const Error error = refusal("[model]\nname = \"baseline\"\n[atmosphere]\ntec_source = \"header\"");
    EXPECT_EQ(error.code, ErrorCode::input);
    EXPECT_THAT(error.message, Not(testing::IsEmpty()));
}

TEST(Assembly, TheDigestIsOfEverythingThatDecidesTheBytes) {
    const std::string run = "[run]\nstart = 2024-03-05T12:00:00Z\n";
    const std::string digest = assembled(run).digest;
    EXPECT_EQ(digest.size(), 16U);
    EXPECT_EQ(assembled(run).digest, digest);
    EXPECT_NE(assembled(run + "seed = 2").digest, digest);
    EXPECT_NE(assembled(run + "[model]\nname = \"ideal\"").digest, digest);
    EXPECT_NE(assembled("[run]\nstart = 2024-03-05T12:00:01Z\n").digest, digest);
    RunMode later = virtual_mode();
    later.now += std::chrono::seconds(1);
    EXPECT_NE(assembled("", later).digest, assembled("").digest) << "a run from now starts elsewhere each time";
}

TEST(Assembly, TheDigestKnowsWhatTheFilesHoldThatARunReads) {
    const test::TemporaryFolder folder;
    const auto file = folder / "read.toml";
    const auto digest_of = [&](const Scenario& scenario, const char* content) {
        std::ofstream(file) << content;
        return scenario_digest(scenario, emulator_data(), virtual_mode().now);
    };
    const std::pair<const char*, std::function<void(Scenario&)>> readers[] = {
        {"navigation", [&](Scenario& s) { s.sky.navigation = {file}; }},
        {"track", [&](Scenario& s) { s.trajectory = FileSettings{file}; }},
        {"board", [&](Scenario& s) { s.receivers[0].board = file.string(); }},
        {"state", [&](Scenario& s) { s.receivers[0].state_file = file; }},
        {"IONEX", [&](Scenario& s) { s.model.modern.ionosphere_maps = file; }},
        {"electron content", [&](Scenario& s) { s.tec_maps = file; }},
        {"tables", [&](Scenario& s) { s.model.modern.tables = {file}; }}};
    for (const auto& [name, read] : readers) {
        Scenario scenario = emulator_scenario("");
        read(scenario);
        const std::string digest = digest_of(scenario, "a");
        EXPECT_EQ(digest_of(scenario, "a"), digest) << name;
        EXPECT_NE(digest_of(scenario, "b"), digest) << name;
    }
}

TEST(Assembly, TheDigestKnowsWhatABoardExtends) {
    const test::TemporaryFolder folder;
    std::ofstream(folder / "child.toml") << "extends = \"parent.toml\"\n";
    Scenario scenario = emulator_scenario("");
    scenario.receivers[0].board = (folder / "child.toml").string();
    const auto digest_with = [&](const char* parent) {
        std::ofstream(folder / "parent.toml") << parent;
        return scenario_digest(scenario, emulator_data(), virtual_mode().now);
    };
    const std::string digest = digest_with("[uart]\nbaud = 9600\n");
    EXPECT_EQ(digest_with("[uart]\nbaud = 9600\n"), digest);
    EXPECT_NE(digest_with("[uart]\nbaud = 38400\n"), digest);
}

TEST(Assembly, AWireDoesNotTakeThePlaceOfWhatTheRunReads) {
    const test::TemporaryFolder folder;
    const auto file = folder / "read.toml";
    std::filesystem::copy_file(emulator_data().folders.at(0) / "boards/receivers/ublox-m8.toml", file);
    const std::pair<const char*, std::function<void(Scenario&)>> readers[] = {
        {"scenario", [&](Scenario& s) { s.name = file.string(); }},
        {"trajectory", [&](Scenario& s) { s.trajectory_file = file; }},
        {"board", [&](Scenario& s) { s.receivers[0].board = file.string(); }},
        {"IONEX", [&](Scenario& s) { s.model.modern.ionosphere_maps = file; }},
        {"electron content", [&](Scenario& s) { s.tec_maps = file; }},
        {"tables", [&](Scenario& s) { s.model.modern.tables = {file}; }}};
    for (const auto& [name, read] : readers) {
        Scenario scenario = emulator_scenario("[model]\nname = \"ideal\"");
        scenario.receivers[0].ports = {"file:" + file.string()};
        read(scenario);
        const auto refused = assemble(scenario, emulator_data(), virtual_mode());
        ASSERT_FALSE(refused) << name;
        EXPECT_EQ(refused.error().code, ErrorCode::usage) << name;
        EXPECT_THAT(refused.error().message, HasSubstr("this file is read, too, and would be lost")) << name;
    }
}

TEST(Assembly, AWireDoesNotTakeThePlaceOfWhatIsRepeated) {
    const test::TemporaryFolder folder;
    std::ofstream(folder / "port0.in");
    std::ofstream(folder / "port0.in_times");
    RunMode mode = virtual_mode();
    mode.repeat = folder / ".";
    for (const char* name : {"port0.in", "port0.in_times"})
        EXPECT_THAT(refusal("[[receiver]]\nport = \"file:" + (folder / name).string() + "\"", mode).message,
                    HasSubstr("this file is read, too, and would be lost"));
}

TEST(Assembly, WhatAReceiverSavesHasAFolder) {
    const test::TemporaryFolder folder;
    const auto receiver = [&](const char* file) {
        return "[[receiver]]\nstate_file = \"" + (folder / file).string() + "\"";
    };
    const Error refused = refusal(receiver("run/m8.state"));
    EXPECT_EQ(refused.code, ErrorCode::outside);
    EXPECT_THAT(refused.message, HasSubstr(":14: receiver.state_file: " + (folder / "run/m8.state").string() +
                                           ": cannot be written: No such file or directory"));
    RunMode mode = virtual_mode();
    mode.record = folder / "run";
    EXPECT_TRUE(assembled(receiver("run/m8.state"), mode).emulator) << "that of the recording is made";
    EXPECT_TRUE(assembled(receiver("m8.state")).emulator);
}

TEST(Assembly, PortsAreOpenedOnlyWhenAskedFor) {
    const test::TemporaryFolder folder;
    const std::string receiver = "[[receiver]]\nport = \"file:" + (folder / "out.nmea").string() + "\"";
    EXPECT_TRUE(assembled(receiver).emulator->wires().empty());
    EXPECT_FALSE(std::filesystem::exists(folder / "out.nmea"));
    RunMode open = virtual_mode();
    open.open_ports = true;
    const Assembly opened = assembled(receiver, open);
    EXPECT_EQ(opened.emulator->wires().size(), 1U);
    EXPECT_TRUE(std::filesystem::exists(folder / "out.nmea"));
    EXPECT_THAT(refusal("[[receiver]]\nport = \"pigeon:1\"", open).message, HasSubstr("pigeon"));
    EXPECT_THAT(refusal("[[receiver]]\nport = \"pigeon:1\"").message, HasSubstr("pigeon")) << "though none is opened";
}

TEST(Assembly, ARecordingThatCannotBeMadeIsTheOutsideWorldsFailure) {
    RunMode mode = virtual_mode();
    mode.record = "/dev/null/run";
    EXPECT_EQ(refusal("", mode).code, ErrorCode::outside);
}

TEST(Assembly, ARunThatIsRefusedLeavesAFormerRecordingAsItWas) {
    const test::TemporaryFolder folder;
    std::filesystem::create_directory(folder / "run");
    std::ofstream(folder / "run/fixes.csv") << "of a former run";
    RunMode mode = virtual_mode();
    mode.open_ports = true;
    mode.record = folder / "run";
    EXPECT_EQ(refusal("[[receiver]]\nport = \"file:/dev/null/no\"", mode).code, ErrorCode::outside);
    EXPECT_EQ(test::content_of(folder / "run/fixes.csv"), "of a former run");
    EXPECT_TRUE(Recorder::claim(folder / "run")) << "it is free again";
    mode.record = folder / "new";
    (void)refusal("[[receiver]]\nport = \"file:/dev/null/no\"", mode);
    EXPECT_FALSE(std::filesystem::exists(folder / "new"));
}

TEST(Assembly, ARecordingDoesNotTakeThePlaceOfWhatTheRunReads) {
    const test::TemporaryFolder folder;
    std::filesystem::create_directory(folder / "run");
    std::ofstream(folder / "run/fixes.csv") << "time_s,lat_deg,lon_deg,height_m\n0,47,8,500\n9,47.001,8,500\n";
    std::filesystem::create_symlink(folder / "run/fixes.csv", folder / "track.csv");
    for (const char* name : {"run/fixes.csv", "track.csv"}) {
        const std::string track =
            "[trajectory]\nkind = \"file\"\npath = \"" + (folder / name).string() + "\"\n[run]\nduration_s = 5\n";
        RunMode mode = virtual_mode();
        mode.record = folder / "run";
        const Error refused = refusal(track, mode);
        EXPECT_EQ(refused.code, ErrorCode::usage);
        EXPECT_THAT(refused.message, HasSubstr("would take the place of it; expected another folder than"));
        mode.record = folder / "other";
        EXPECT_TRUE(assembled(track, mode).emulator);
    }
}

firmware::BoardProfile board_of(const char* name) { return find_board(name, board_folders(emulator_data())).value(); }

TEST(ReceiverSettingsOfAScenario, TracksWhatTheBoardTracksUnlessToldOtherwise) {
    firmware::BoardProfile board = board_of("ublox-m8");
    board.constellations = {Constellation::gps, Constellation::glonass};
    const ReceiverSettings plain = receiver_settings(emulator_scenario(""), board);
    EXPECT_EQ(plain.signals.size(), 2U);
    EXPECT_TRUE(plain.tracks(Constellation::gps, Signal::l1));
    EXPECT_TRUE(plain.tracks(Constellation::glonass, first_signal(Constellation::glonass)));
    EXPECT_FALSE(plain.tracks(Constellation::galileo, first_signal(Constellation::galileo)));
    const ReceiverSettings told =
        receiver_settings(emulator_scenario("[[receiver]]\nconstellations = [\"galileo\"]"), board);
    EXPECT_EQ(told.signals.size(), 1U);
    EXPECT_TRUE(told.tracks(Constellation::galileo, first_signal(Constellation::galileo)));
}

TEST(ReceiverSettingsOfAScenario, DualFrequencyAddsTheSecondSignals) {
    const ReceiverSettings both = receiver_settings(
        emulator_scenario("[[receiver]]\nconstellations = [\"gps\", \"galileo\"]\ndual_frequency = true"),
        board_of("ublox-f9p"));
    EXPECT_EQ(both.signals.size(), 4U);
    for (const Constellation c : {Constellation::gps, Constellation::galileo})
        for (const Signal signal : {emulated_signals(c)[0], emulated_signals(c)[1]})
            EXPECT_TRUE(both.tracks(c, signal)) << constellation_name(c);
}

TEST(ReceiverSettingsOfAScenario, TheBoardSaysInWhichBandTheSecondSignalsAre) {
    for (const char* board : {"ublox-f10", "airoha-ag33xx"}) {
        const ReceiverSettings l5 = receiver_settings(emulator_scenario("[[receiver]]"), board_of(board));
        for (const Constellation c :
             {Constellation::gps, Constellation::galileo, Constellation::beidou, Constellation::qzss}) {
            EXPECT_TRUE(l5.tracks(c, first_signal(c)) && l5.tracks(c, Signal::l5)) << constellation_name(c);
            EXPECT_FALSE(l5.tracks(c, Signal::l2) || l5.tracks(c, Signal::e5b)) << constellation_name(c);
        }
        EXPECT_FALSE(l5.tracks(Constellation::glonass, Signal::g2));
    }
}

TEST(ReceiverSettingsOfAScenario, TakesStartMotionAndMaskOver) {
    const ReceiverSettings s =
        receiver_settings(emulator_scenario("[sky]\nelevation_mask_deg = 12.5\n[[receiver]]\nstart = \"cold\"\n"
                                            "dynamic_model = \"sea\"\nstatic_hold_mps = 0.25"),
                          board_of("ublox-m8"));
    EXPECT_NEAR(s.elevation_mask.deg(), 12.5, 1e-12);
    EXPECT_EQ(s.start, StartKind::cold);
    EXPECT_EQ(s.dynamic_model, DynamicModel::sea);
    EXPECT_EQ(s.static_hold_below, MetresPerSecond(0.25));
    EXPECT_EQ(receiver_settings(emulator_scenario(""), board_of("ublox-m8")).start, StartKind::hot);
}

TEST(Assembly, AConstellationThatTheReceiverDoesNotTrackIsAWarning) {
    const auto told = HasSubstr("nmea-generic does not track galileo, which sky.constellations names");
    const std::string sky = "[sky]\nconstellations = [\"gps\", \"galileo\"]\n";
    const std::string board = "[[receiver]]\nboard = \"nmea-generic\"\n";
    EXPECT_THAT(assembled(sky + board + "constellations = [\"gps\"]").warnings, Contains(told));
    EXPECT_THAT(assembled(sky + board + "constellations = [\"gps\", \"galileo\"]").warnings, Not(Contains(told)));
    EXPECT_THAT(assembled(board + "constellations = [\"gps\"]").warnings, Not(Contains(told))) << "nobody asked for it";
    EXPECT_THAT(assembled(sky + board + "constellations = [\"gps\"]\n[model]\nname = \"ideal\"").warnings,
                Not(Contains(told)))
        << "sensor models take what is in the sky";
}

TEST(Assembly, KeysOfRoutesBesideTimesAreAWarning) {
    const test::TemporaryFolder folder;
    const std::filesystem::path file = folder.path() / "track.csv";
    const auto warnings = [&](const std::string& rows, const std::string& keys) {
        std::ofstream(file) << rows;
        return assembled("[trajectory]\nkind = \"file\"\npath = \"" + file.string() + "\"\n" + keys).warnings;
    };
    const std::string timed = "t_s,lat_deg,lon_deg,h_ell_m\n0,46,7,100\n1,46.0001,7,100\n2,46.0002,7,100\n";
    const auto told = HasSubstr("its rows have times; speed_mps and route_tolerance_m are of files without");
    EXPECT_THAT(warnings(timed, "speed_mps = 3"), Contains(told));
    EXPECT_THAT(warnings(timed, "route_tolerance_m = 3"), Contains(told));
    EXPECT_THAT(warnings(timed, ""), Not(Contains(told)));
}

TEST(Assembly, AReceiverBeginsAtTheSpeedBehindTheAddressOfItsWire) {
    const auto baud = [](const std::string& keys) {
        return assembled("[[receiver]]\nboard = \"ublox-m10\"\n" + keys)
            .emulator->receiver()
            .baud(firmware::PortId::uart1);
    };
    EXPECT_EQ(baud("port = \"tcp:0\""), 38400U);
    EXPECT_EQ(baud("port = \"tcp:0@115200\""), 115200U);
    EXPECT_EQ(baud("port = \"tcp-connect:127.0.0.1:9@230400\"\nbaud = 9600"), 230400U);
    EXPECT_EQ(baud("port = [\"pty\", \"uart1=tcp:0@57600\"]"), 57600U);
}

TEST(Assembly, TwoEndsAtOnePlaceAreRefused) {
    const auto two = [](const std::string& a, const std::string& b) {
        return refusal("[[receiver]]\nport = \"" + a + "\"\n[[receiver]]\nport = \"" + b + "\"").message;
    };
    EXPECT_EQ(two("pty:/tmp/gps", "pty:/tmp/gps"),
              "test.toml:4:8: receiver.port: port of 'receiver1' 'pty:/tmp/gps' is where port of 'receiver0' "
              "'pty:/tmp/gps' goes; expected another place");
    EXPECT_THAT(two("file:a.bin", "file:./b/../a.bin"), HasSubstr("expected another place"));
    EXPECT_THAT(two("tcp:2000", "rfc2217:2000"), HasSubstr("expected another place"));
    EXPECT_THAT(two("-", "-"), HasSubstr("expected another place"));
    EXPECT_THAT(two("serial:/dev/ttyS7@9600", "serial:/dev/ttyS7"), HasSubstr("expected another place"));
    for (const char* shared : {"pty", "file:/dev/null", "tcp:0", "tcp-connect:127.0.0.1:2000", "client:careful-ubx"})
        EXPECT_EQ(two(shared, shared), "accepted") << shared;
    EXPECT_EQ(two("tcp:2000", "tcp:2001"), "accepted");
    EXPECT_THAT(refusal("[[receiver]]\nport = [\"uart1=pty:/tmp/gps\", \"uart2=pty:/tmp/gps\"]").message,
                HasSubstr("expected another place"));
    EXPECT_THAT(refusal("[[output]]\nto = \"json-file:o.json\"\n[[output]]\nto = \"json-file:o.json\"").message,
                HasSubstr("output 'json-file:o.json' is where output"));
}

TEST(Assembly, AFaultThatWillShowNothingIsAWarning) {
    const auto told = [](const std::string& fault, const std::string& rest = "") {
        for (const std::string& warning : assembled("[[fault]]\nkind = " + fault + "\n" + rest).warnings)
            if (warning.find("[[fault]]") != std::string::npos) return warning;
        return std::string();
    };
    const auto tracks_none = HasSubstr("'outage' will show nothing: no receiver tracks what it is for");
    EXPECT_THAT(told("\"outage\"\nconstellations = [\"galileo\"]"), tracks_none)
        << "the board is one of GPS and GLONASS";
    EXPECT_THAT(told("\"outage\"\nconstellations = [\"glonass\"]"), "");
    EXPECT_THAT(told("\"outage\"\nsatellites = [\"E05\"]"), tracks_none);
    EXPECT_THAT(told("\"outage\"\nsatellites = [\"R05\", \"G05\"]"), "");
    EXPECT_THAT(told("\"outage\"\nsignals = [\"L5\"]"), tracks_none);
    EXPECT_THAT(told("\"outage\"\nsignals = [\"L2\"]", "[[receiver]]\nboard = \"ublox-f9p\""), "");
    EXPECT_THAT(told("\"outage\"\nazimuth_from_deg = 10\nazimuth_to_deg = 20"), "");
    EXPECT_THAT(told("\"outage\"\nsatellites = [\"E05\"]", "[model]\nname = \"ideal\""), tracks_none);
    EXPECT_THAT(told("\"heading_lost\""), HasSubstr("no base antenna"));
    EXPECT_THAT(
        told("\"heading_lost\"", "[[receiver]]\nname = \"a\"\n[[receiver]]\nboard = \"ublox-f9p\"\nbase = \"a\""), "");
    EXPECT_THAT(told("\"multipath_burst\"", "[model]\nerrors = \"none\""), HasSubstr("leaves echoes out"));
    EXPECT_THAT(told("\"multipath_burst\""), "");
    for (const std::string model : {"constant-sigma", "ideal", "refraction", "satellite-count"})
        EXPECT_THAT(told("\"ionospheric_storm\"\nvertical_delay_m = 10", "[model]\nname = \"" + model + "\""),
                    HasSubstr("has no ionosphere"));
    for (const std::string model : {"baseline", "whole-path", "modern"})
        EXPECT_THAT(told("\"ionospheric_storm\"\nvertical_delay_m = 10", "[model]\nname = \"" + model + "\""), "");
    EXPECT_THAT(told("\"clock_drift\""), HasSubstr("in virtual time nothing does"));
}

TEST(Assembly, AWarmStartKnowsWhereItIs) {
    for (const char* keys : {"start = \"warm\"", "start = \"warm\"\npower_up = true", "power_up = true"}) {
        const Assembly run = assembled("[[receiver]]\n" + std::string(keys));
        const firmware::NavigationState& state = run.emulator->receiver().state();
        EXPECT_TRUE(state.position_known && state.ever_had_fix && state.only_place_known) << keys;
        const TruthState truth = run.emulator->simulation().truth_at(run.start);
        EXPECT_LT((to_ecef(state.epoch.fix.position) - truth.position).length().value(), 1e-3) << keys;
        EXPECT_FALSE(state.epoch.fix.has_position()) << "but not yet as a fix";
    }
    for (const char* keys : {"start = \"cold\"", "start = \"cold\"\npower_up = true"}) {
        const Assembly run = assembled("[[receiver]]\n" + std::string(keys));
        EXPECT_FALSE(run.emulator->receiver().state().position_known) << keys;
    }
}

TEST(Assembly, OnlyTheModernModelMeasures) {
    for (const std::string_view name : model_names())
        EXPECT_EQ(assembled("[model]\nname = \"" + std::string(name) + "\"").emulator->simulation().measures(),
                  name == "modern")
            << name;
}

TEST(MakeTrajectory, BeginsAtTheStart) {
    const GpsTime start = to_gps_time(2304, 0);
    const Geodetic a = Geodetic::degrees(46, 30, 10);
    const auto fixed = make_trajectory(FixedSettings{a}, start);
    EXPECT_EQ(fixed->at(start + std::chrono::hours(1)).geodetic.latitude, a.latitude);
    const auto path = make_trajectory(
        WaypointSettings{{{a, MetresPerSecond(10), Seconds(5)}, {Geodetic::degrees(46.01, 30, 10), {}, {}}}}, start);
    EXPECT_EQ(path->at(start + std::chrono::seconds(4)).geodetic.latitude, a.latitude);
    EXPECT_GT(path->at(start + std::chrono::seconds(6)).geodetic.latitude, a.latitude);
    CircleSettings circle;
    circle.shape.centre = a;
    const auto round = make_trajectory(circle, start);
    EXPECT_NEAR((round->at(start).position - to_ecef(a)).length().value(), 100, 1e-3);
    EXPECT_NEAR(round->at(start).velocity.vector().norm(), 10, 1e-3);
}

TEST(Assembly, TellsOfKeysAndWeatherThatCannotAct) {
    const auto idle = testing::Contains(HasSubstr("model.modern.ionosphere.content_tecu: has no effect here"));
    const std::string content = "[model.modern.ionosphere]\ncontent_tecu = 100\n";
    EXPECT_THAT(assembled(content).warnings, idle);
    EXPECT_THAT(assembled("[model]\nname = \"ideal\"\n" + content).warnings, Not(idle)) << "nobody asked for modern";
    const std::string mountain = "[trajectory]\nkind = \"fixed\"\nat = [-16.5, -68.15, 4100]\n[atmosphere]\n";
    EXPECT_THAT(assembled(mountain + "rain_mm_h = 100").warnings, Contains(HasSubstr("rain falls from 4000 m above")));
    EXPECT_THAT(assembled(mountain + "[[atmosphere.cloud]]\nkind = \"fog\"").warnings,
                Contains(HasSubstr("atmosphere.cloud: fog ends")));
    EXPECT_THAT(assembled(mountain + "rain_mm_h = 100\nrain_top_m = 5000").warnings,
                Not(Contains(HasSubstr("rain falls from"))));
    EXPECT_THAT(assembled("[model]\nname = \"whole-path\"\n" + mountain + "rain_mm_h = 100").warnings,
                Not(Contains(HasSubstr("rain falls from"))))
        << "which would weaken nothing below its top, either";
}

TEST(Assembly, TellsOfTheAirThatItsModelDoesNotTake) {
    const auto of_model = [](const std::string& name) {
        const std::string air = "[atmosphere]\nrain_mm_h = 100\nzenith_wet_delay_m = 0.1\nenvironment = \"city\"\n";
        return assembled("[model]\nname = \"" + name + "\"\n" + air).warnings;
    };
    const auto idle = [](const std::string& keys) { return Contains(StartsWith(keys + ": without effect in ")); };
    EXPECT_THAT(of_model("modern"), idle("atmosphere.environment, atmosphere.zenith_wet_delay_m"));
    EXPECT_THAT(of_model("whole-path"), idle("atmosphere.rain_mm_h"));
    for (const char* name : {"refraction", "ideal", "constant-sigma", "satellite-count"})
        EXPECT_THAT(of_model(name), idle("atmosphere.rain_mm_h, atmosphere.zenith_wet_delay_m")) << name;
    EXPECT_THAT(of_model("baseline"), Not(Contains(HasSubstr("without effect in"))));
}

// Two maps of the whole globe, at 22 and 24 o'clock of 1 January 2017.
std::string ionex_of_an_evening() {
    const auto headed = [](const std::string& text, const char* label) {
        return fmt::format("{:<60}{}\n", text, label);
    };
    std::string text = headed("     1.0            IONOSPHERE MAPS     GPS", "IONEX VERSION / TYPE") +
                       headed("    60.0 -60.0 -30.0", "LAT1 / LAT2 / DLAT") +
                       headed("  -180.0 180.0  60.0", "LON1 / LON2 / DLON") + headed("", "END OF HEADER");
    for (const int hour : {22, 24}) {
        text += headed("     1", "START OF TEC MAP") +
                headed(fmt::format("  2017     1     1{:6}     0     0", hour), "EPOCH OF CURRENT MAP");
        for (const int latitude : {60, 30, 0, -30, -60})
            text += headed(fmt::format("  {:6.1f}-180.0 180.0  60.0 450.0", double(latitude)), "LAT/LON1/LON2/DLON/H") +
                    "  100  100  100  100  100  100  100\n";
        text += headed("     1", "END OF TEC MAP");
    }
    return text + headed("", "END OF FILE");
}

TEST(Assembly, TellsWhenTheMapsOfARunWithoutAnEndDo) {
    const test::TemporaryFolder folder;
    const std::filesystem::path file = folder / "evening.17i";
    std::ofstream(file) << ionex_of_an_evening();
    const std::string ionosphere = "[model.modern.ionosphere]\nmaps = \"" + file.string() + "\"\ntruth = ";
    const std::string evening = "[run]\nstart = 2017-01-01T23:30:00Z\n";
    const auto told = Contains(HasSubstr("evening.17i: its maps reach to 2017-01-02T00:00:00Z; the run has no end"));
    EXPECT_THAT(assembled(evening + ionosphere + "\"ionex\"").warnings, told);
    EXPECT_THAT(assembled(evening + "duration_s = 60\n" + ionosphere + "\"ionex\"").warnings, Not(told));
    EXPECT_THAT(assembled(evening + ionosphere + "\"constant\"").warnings, Not(told)) << "none of them acts";
    EXPECT_THAT(refusal("[run]\nstart = 2017-01-02T00:30:00Z\n" + ionosphere + "\"ionex\"").message,
                HasSubstr("its maps span 2017-01-01T22:00:00Z to 2017-01-02T00:00:00Z"));
}

TEST(Assembly, TellsOfPathsBeyondTheLimitsOfItsReceiver) {
    const std::string run = "[run]\nstart = 2024-03-05T12:00:00Z\nduration_s = 9000\n";
    const std::string balloon =
        run + "[trajectory]\nat = [28.5, -80.6, 3]\nkind = \"balloon\"\npreset = \"balloon_32km\"\n[[receiver]]\n";
    const auto beyond = Contains(HasSubstr("tells no fix"));
    EXPECT_THAT(assembled(balloon + "board = \"ublox-f9p\"").warnings,
                Contains(AllOf(StartsWith("ublox-f9p tells no fix in "), HasSubstr(" % of the run, from "),
                               HasSubstr("is beyond the limits of its dynamic_model"))));
    EXPECT_THAT(assembled(balloon + "board = \"ublox-f9p\"\ndynamic_model = \"airborne-1g\"").warnings, Not(beyond));
    EXPECT_THAT(assembled(balloon + "board = \"septentrio-sbf\"").warnings, Not(beyond)) << "those are u-blox's";
    EXPECT_THAT(assembled(balloon + "board = \"septentrio-sbf\"\nexport_limits = \"or\"").warnings,
                Contains(HasSubstr("is beyond its export_limits")));
    EXPECT_THAT(assembled(run + "[trajectory]\nkind = \"fixed\"\nat = [28, 87, 13000]").warnings,
                Contains(HasSubstr("tells no fix in the whole run: 130")));
    EXPECT_THAT(assembled(run +
                          "[trajectory]\nkind = \"circle\"\ncentre = [28, -80, 3]\nradius_m = 50000\nspeed_mps = "
                          "600\n[[receiver]]\n" +
                          "board = \"septentrio-sbf\"")
                    .warnings,
                Contains(HasSubstr("is beyond 500 m/s, from which on no receiver does")));
}

TEST(Assembly, TakesTheHeightOfWeatherAsTheModelDoes) {
    const std::string weather = "[atmosphere]\nrain_mm_h = 100\n";
    const auto below = Contains(HasSubstr("below the antenna"));
    // The geoid lies 97 m below the ellipsoid here, and 85 m above it there.
    const std::string deep = "[trajectory]\nkind = \"fixed\"\nat = [5, 79, 3950]\n" + weather;
    const std::string raised = "[trajectory]\nkind = \"fixed\"\nat = [-8.5, 147, 4050]\n" + weather;
    const std::string baseline = "[model]\nname = \"baseline\"\n";
    EXPECT_THAT(assembled(deep).warnings, below) << "4047 m above the sea";
    EXPECT_THAT(assembled(raised).warnings, Not(below)) << "3975 m above the sea, in the rain";
    EXPECT_THAT(assembled(baseline + deep).warnings, Not(below));
    EXPECT_THAT(assembled(baseline + raised).warnings, Contains(HasSubstr("above the ellipsoid, below the antenna")));
}

}  // namespace
}  // namespace skyloop
