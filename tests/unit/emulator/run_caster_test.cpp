#include "run/emulator/run_caster.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "receiver/protocol/nmea_sentence.hpp"
#include "run/emulator/wires.hpp"
#include "run/scenario/scenario_file.hpp"
#include "support/run_parts.hpp"

namespace skyloop {
namespace {

using testing::HasSubstr;

const GpsTime caster_begin = to_gps_time(2400, 0.0);

std::shared_ptr<PortCorrections> base_port() {
    SourceRecord about;
    about.mount = "BASE";
    return std::make_shared<PortCorrections>(about, Geodetic::degrees(10, 20, 0), false);
}

// Of GPS, with the C/A code, or with that and L2C.
Bytes observations(int number, std::uint32_t signals) {
    Rtcm3MsmHeader header;
    header.number = number;
    header.satellites = std::uint64_t{1} << 63;
    header.signals = signals;
    header.cells.assign(static_cast<std::size_t>(header.signal_count()), true);
    return encode(header);
}

constexpr std::uint32_t only_l1 = 1U << 30, l1_and_l2 = 1U << 30 | 1U << 17;

Bytes place_at(const Geodetic& place) {
    const Position<Ecef> point = to_ecef(place);
    Rtcm3Station station;
    for (int axis = 0; axis < 3; ++axis)
        station.position[static_cast<std::size_t>(axis)] = static_cast<std::int64_t>(point.vector()[axis] * 1e4);
    return encode(station);
}

TEST(PortCorrections, GiveEachClientWhatComesAfterIt) {
    const auto port = base_port();
    const Bytes first = observations(1074, only_l1), second = observations(1084, only_l1);
    const auto early = port->open();
    EXPECT_TRUE(port->hear(first, caster_begin));
    const auto late = port->open();
    EXPECT_TRUE(port->hear(second, caster_begin));
    Bytes both = first;
    both.insert(both.end(), second.begin(), second.end());
    EXPECT_EQ(early->take(), both);
    EXPECT_EQ(late->take(), second);
    EXPECT_TRUE(early->take().empty());
    early->hear_position("$GPGGA,,*00");
    EXPECT_TRUE(early->take().empty());
}

TEST(PortCorrections, AreRtcmAloneAndWhole) {
    const auto port = base_port();
    const auto client = port->open();
    const Bytes frame = observations(1074, only_l1);
    Bytes stream = to_bytes("$GNRMC,1*00\r\n");
    stream.insert(stream.end(), frame.begin(), frame.end());
    const ByteSpan bytes(stream);
    EXPECT_FALSE(port->hear(bytes.first(20), caster_begin));
    EXPECT_TRUE(client->take().empty());
    EXPECT_TRUE(port->hear(bytes.subspan(20), caster_begin));
    EXPECT_EQ(client->take(), frame);
}

TEST(PortCorrections, KeepNoMoreThanTheNewest) {
    const auto port = base_port();
    const auto client = port->open();
    const Bytes frame = encode_rtcm3(Bytes(1000, 0x43));
    for (int i = 0; i < 1000; ++i)
        port->hear(frame, caster_begin);
    const Bytes taken = client->take();
    EXPECT_LE(taken.size(), 256U << 10U);
    EXPECT_GT(taken.size(), 250U << 10U);
    EXPECT_EQ(taken.size() % frame.size(), 0U);
}

TEST(PortCorrections, TellTheSourceTableWhatHasBeenSent) {
    const auto port = base_port();
    EXPECT_THAT(port->table_line(false), HasSubstr(";RTCM 3.3;;0;;none;;10.00;20.00;0;0;skyloop;none;N;N;0;"));
    for (int i = 0; i < 11; ++i) {
        const GpsTime now = caster_begin + std::chrono::seconds(i);
        if (i % 5 == 0) port->hear(place_at(Geodetic::degrees(46.4775, -30.7326, 77)), now);
        port->hear(observations(1074, only_l1), now);
        port->hear(observations(1124, only_l1), now);
        port->hear(observations(1124, only_l1), now + std::chrono::milliseconds(500));
    }
    EXPECT_THAT(port->table_line(true), HasSubstr(";1005(5),1074(1),1124(0.5);1;GPS+BDS;none;;46.48;-30.73;0;0;"));
    EXPECT_THAT(port->table_line(true), HasSubstr(";B;N;"));
    port->hear(observations(1077, l1_and_l2), caster_begin);
    EXPECT_THAT(port->table_line(true), HasSubstr(";2;GPS+BDS;"));
}

firmware::BoardProfile board_with_two_ports() {
    firmware::BoardProfile board;
    board.name = "toy";
    board.ports = {firmware::PortId::uart1, firmware::PortId::uart2};
    return board;
}

TEST(CorrectionsOfAReceiver, NameTheirPort) {
    ReceiverEntry entry;
    EXPECT_EQ(corrections_of(entry, board_with_two_ports()).value(), std::nullopt);
    entry.corrections = "ntrip://me:pw@host/M";
    const auto plain = corrections_of(entry, board_with_two_ports()).value();
    ASSERT_TRUE(plain);
    EXPECT_EQ(plain->port, firmware::PortId::uart1);
    EXPECT_TRUE(plain->corrections);
    entry.corrections = "uart2=ntrip://me:p=w@host/M";
    const auto named = corrections_of(entry, board_with_two_ports()).value();
    ASSERT_TRUE(named);
    EXPECT_EQ(named->port, firmware::PortId::uart2);
    EXPECT_EQ(named->uri, "ntrip://me:p=w@host/M");
}

TEST(CorrectionsOfAReceiver, AreRefusedWithoutSecrets) {
    ReceiverEntry entry;
    for (const char* wrong : {"usb=ntrip://me:secret@host/M", "ntrip://me:secret@host", "tcp:2000"}) {
        entry.corrections = wrong;
        const auto refused = corrections_of(entry, board_with_two_ports());
        ASSERT_FALSE(refused) << wrong;
        EXPECT_EQ(refused.error().code, ErrorCode::usage);
        EXPECT_EQ(refused.error().message.find("secret"), std::string::npos) << refused.error().message;
    }
}

TEST(Caster, IsReadFromAScenario) {
    const auto scenario = read_scenario(
        "[[receiver]]\nname = \"base\"\n[[receiver]]\nname = \"other\"\n"
        "[caster]\nlisten = \"0.0.0.0:2101\"\n[caster.users]\nrover = \"secret\"\n\"a b\" = \"\"\n"
        "[[caster.mount]]\nname = \"A\"\n[[caster.mount]]\nname = \"B-1.x_\"\nreceiver = \"other\"\nport = \"uart2\"\n",
        "test.toml");
    ASSERT_TRUE(scenario) << scenario.error().message;
    EXPECT_EQ(scenario->caster.listen, "0.0.0.0:2101");
    EXPECT_EQ(scenario->caster.users, (std::map<std::string, std::string>{{"a b", ""}, {"rover", "secret"}}));
    ASSERT_EQ(scenario->caster.mounts.size(), 2U);
    EXPECT_EQ(scenario->caster.mounts[0].receiver, 0U);
    EXPECT_EQ(scenario->caster.mounts[1].name, "B-1.x_");
    EXPECT_EQ(scenario->caster.mounts[1].receiver, 1U);
    EXPECT_EQ(scenario->caster.mounts[1].port, "uart2");
}

TEST(Caster, HasMountPointsOfVirtualStations) {
    const auto scenario = read_scenario(
        "[caster]\nlisten = \"1\"\n[[caster.mount]]\nname = \"VRS\"\nvirtual = true\nmsm = 4\n"
        "[[caster.mount]]\nname = \"VRS7\"\nvirtual = true\n[[caster.mount]]\nname = \"BASE\"\n",
        "test.toml");
    ASSERT_TRUE(scenario) << scenario.error().message;
    const std::vector<CasterMount>& mounts = scenario->caster.mounts;
    ASSERT_EQ(mounts.size(), 3U);
    EXPECT_TRUE(mounts[0].virtual_station && mounts[1].virtual_station);
    EXPECT_FALSE(mounts[2].virtual_station);
    EXPECT_EQ(mounts[0].msm, 4);
    EXPECT_EQ(mounts[1].msm, 7);
}

Scenario with_mount(const std::string& mount, const std::string& more = "") {
    return read_scenario("[run]\nstart = 2024-03-05T12:00:00Z\n" + more +
                             "[caster]\nlisten = \"127.0.0.1:0\"\n[[caster.mount]]\nname = \"A\"\n" + mount,
                         "test.toml")
        .value();
}

Result<Assembly> assembled_for_caster(const Scenario& scenario) {
    RunMode mode;
    mode.virtual_time = true;
    mode.open_ports = false;
    return assemble(scenario, test::emulator_data(), mode);
}

TEST(Caster, ServesVirtualStationsOfAnyBoard) {
    const Scenario scenario = with_mount("virtual = true\n");
    auto assembly = assembled_for_caster(scenario);
    ASSERT_TRUE(assembly) << assembly.error().message;
    const CasterHost host{test::emulator_data(), "1.2"};
    EXPECT_TRUE(RunCaster::check(scenario, *assembly, host));
    const auto caster = RunCaster::start(scenario, *assembly, host);
    ASSERT_TRUE(caster) << caster.error().message;
    EXPECT_THAT(caster->description(), HasSubstr(" (A)"));
}

TEST(Caster, HasVirtualStationsBesideTheMountPointsOfItsReceivers) {
    const auto scenario = [](const std::string& name) {
        return read_scenario(
                   "[run]\nstart = 2024-03-05T12:00:00Z\n[[receiver]]\nname = \"base\"\nboard = \"ublox-f9p\"\n"
                   "[caster]\nlisten = \"127.0.0.1:0\"\nvirtual = \"" +
                       name + "\"\n",
                   "test.toml")
            .value();
    };
    const CasterHost host{test::emulator_data(), "1.2"};
    auto assembly = assembled_for_caster(scenario("VRS"));
    ASSERT_TRUE(assembly) << assembly.error().message;
    const auto caster = RunCaster::start(scenario("VRS"), *assembly, host);
    ASSERT_TRUE(caster) << caster.error().message;
    EXPECT_THAT(caster->description(), HasSubstr(" (base, VRS)"));
    const auto taken = RunCaster::check(scenario("base"), *assembly, host);
    ASSERT_FALSE(taken);
    EXPECT_THAT(taken.error().message, HasSubstr("caster.virtual: 'base' is the mount point of a receiver"));
}

TEST(Caster, RefusesWhatItsMountPointsCannotBe) {
    for (const auto& [scenario, wanted] : {std::pair{with_mount("virtual = true\n", "[model]\nname = \"baseline\"\n"),
                                                     "expected model.name = \"modern\""},
                                           {with_mount("virtual = false\n"), "ublox-m8 sends no RTCM"}}) {
        auto assembly = assembled_for_caster(scenario);
        ASSERT_TRUE(assembly) << assembly.error().message;
        const auto checked = RunCaster::check(scenario, *assembly, {});
        const auto started = RunCaster::start(scenario, *assembly, {});
        ASSERT_FALSE(checked);
        ASSERT_FALSE(started);
        EXPECT_EQ(checked.error().code, ErrorCode::usage);
        EXPECT_EQ(checked.error().message, started.error().message);
        EXPECT_THAT(checked.error().message, testing::AllOf(HasSubstr("test.toml:"), HasSubstr(wanted)));
    }
}

TEST(Caster, IsRefusedWithItsPlace) {
    for (const auto& [text, wanted] :
         {std::pair{"[caster]\n", "listens nowhere"},
          {"[caster]\nlisten = \"1\"\n[[caster.mount]]\nname = \"a b\"\n", "expected letters, digits"},
          {"[caster]\nlisten = \"1\"\n[[caster.mount]]\nport = \"usb\"\n", "has no name"},
          {"[caster]\nlisten = \"1\"\n[[caster.mount]]\nname = \"a\"\nreceiver = \"x\"\n", "is no receiver of this"},
          {"[caster]\nlisten = \"1\"\n[[caster.mount]]\nname = \"a\"\n[[caster.mount]]\nname = \"a\"\n",
           "is the second"},
          {"[caster]\nlisten = \"1\"\nvirtual = \"a\"\n[[caster.mount]]\nname = \"a\"\n", "is the second"},
          {"[caster]\nlisten = \"1\"\nvirtual = \"\"\n", "expected letters, digits"},
          {"[caster]\nlisten = \"1\"\n[[caster.mount]]\nname = \"a\"\nvirtual = true\nport = \"usb\"\n",
           "port: is of a receiver"},
          {"[caster]\nlisten = \"1\"\n[[caster.mount]]\nname = \"a\"\nmsm = 4\n", "msm: is of virtual stations"},
          {"[caster]\nlisten = \"1\"\n[caster.users]\n\"a:b\" = \"x\"\n", "is no name of a user"}}) {
        const auto scenario = read_scenario(text, "test.toml");
        ASSERT_FALSE(scenario) << text;
        EXPECT_THAT(scenario.error().message, HasSubstr(wanted));
        EXPECT_THAT(scenario.error().message, HasSubstr("test.toml:"));
    }
}

}  // namespace
}  // namespace skyloop
