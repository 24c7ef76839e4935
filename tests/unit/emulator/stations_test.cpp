// Several receivers on one vehicle and one clock, and the ports of each.
#include "run/emulator/station.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <map>
#include <nlohmann/json.hpp>

#include "base/geo/local_frame.hpp"
#include "run/emulator/assembly.hpp"
#include "run/emulator/wires.hpp"
#include "support/run_parts.hpp"
#include "unit/transport/temporary_folder.hpp"

namespace skyloop {
namespace {

using namespace std::chrono_literals;
using test::content_of;
using test::emulator_scenario;
using test::lines_of;
using testing::HasSubstr;

const std::atomic<bool> stations_never_stop{false};

firmware::BoardProfile board_with(std::vector<firmware::PortId> ports) {
    firmware::BoardProfile board;
    board.name = "test-board";
    board.ports = std::move(ports);
    return board;
}

TEST(Wires, ANameChoosesThePort) {
    using firmware::PortId;
    const auto board = board_with({PortId::uart1, PortId::uart2, PortId::usb});
    const auto wire = [&](const char* text) { return parse_wire(text, board).value(); };
    EXPECT_EQ(wire("pty").port, PortId::uart1);
    EXPECT_EQ(wire("uart2=pty:/tmp/gps").port, PortId::uart2);
    EXPECT_EQ(wire("uart2=pty:/tmp/gps").uri, "pty:/tmp/gps");
    EXPECT_EQ(wire("usb=pty").port, PortId::usb);
    EXPECT_EQ(wire("uart1=-").uri, "-");
    EXPECT_EQ(wire("file:/tmp/a=b").uri, "file:/tmp/a=b") << "a path with an equals sign is no name";
    EXPECT_EQ(parse_wire("pty", board_with({PortId::usb}))->port, PortId::usb) << "the only one there is";
    EXPECT_EQ(wire("usbip:3240").port, PortId::usb);
    EXPECT_EQ(wire("uart2=usbip:3240").port, PortId::uart2);
    EXPECT_EQ(parse_wire("usbip:3240", board_with({PortId::uart1}))->port, PortId::uart1) << "it has no USB";
    EXPECT_EQ(wire("client:naive-ubx").uri, "client:naive-ubx");
}

TEST(Wires, OnlyTheUsbPortShowsTheBoard) {
    using firmware::PortId;
    auto board = board_with({PortId::uart1, PortId::usb});
    EXPECT_EQ(usb_face(board, PortId::usb).ids, UsbFace{}.ids);
    board.usb = firmware::UsbDescription{0x1546, 0x01a8, 0x0301, "maker", "receiver", "A1"};
    const UsbFace face = usb_face(board, PortId::usb);
    EXPECT_EQ(to_string(face.ids), "1546:01a8");
    EXPECT_EQ(face.release, 0x0301);
    EXPECT_EQ(face.manufacturer + "/" + face.product + "/" + face.serial, "maker/receiver/A1");
    EXPECT_EQ(to_string(usb_face(board, PortId::uart1).ids), "0525:a4a7") << "a serial adapter";
}

TEST(Wires, AnUnknownNameListsThePortsOfTheBoard) {
    const auto board = board_with({firmware::PortId::uart1, firmware::PortId::usb});
    const auto unknown = parse_wire("uart2=pty", board);
    ASSERT_FALSE(unknown);
    EXPECT_EQ(unknown.error().code, ErrorCode::usage);
    EXPECT_THAT(unknown.error().message,
                testing::AllOf(testing::StartsWith("port 'uart2=pty': test-board has no port 'uart2'"),
                               testing::EndsWith("expected uart1, usb")));
    EXPECT_FALSE(parse_wire("=pty", board));
    EXPECT_THAT(parse_wire("usb=serial:1", board).error().message, HasSubstr("serial"));
    EXPECT_THAT(parse_wire("usb=client:nobody", board).error().message, HasSubstr("careful-ubx, naive-ubx"));
    EXPECT_FALSE(parse_wire("usb=", board));
}

TEST(Wires, ASpeedBehindANetworkAddressIsWhereTheReceiverBegins) {
    using firmware::PortId;
    ReceiverEntry entry;
    entry.ports = {"pty", "tcp-connect:127.0.0.1:5762@115200"};
    EXPECT_EQ(speed_of_wires(entry), 115200U);
    entry.ports = {"uart1=tcp:2000@230400"};
    EXPECT_EQ(speed_of_wires(entry), 230400U);
    entry.ports = {"tcp:2000", "serial:/dev/ttyUSB0@9600"};
    EXPECT_EQ(speed_of_wires(entry), std::nullopt) << "that of a serial line is the line's";
    const auto board = board_with({PortId::uart1, PortId::uart2, PortId::usb});
    EXPECT_EQ(parse_wire("tcp:0@9600", board)->port, PortId::uart1);
    EXPECT_EQ(parse_wire("usb=tcp:0@9600", board).error().message,
              "port 'usb=tcp:0@9600': usb takes no speed; expected @BAUD at uart1 alone");
    EXPECT_FALSE(parse_wire("uart2=tcp:0@9600", board));
    Scenario scenario;
    scenario.receivers = {entry, entry};
    scenario.receivers[1].ports = {"tcp:2000@57600"};
    keep_scripted_clients(scenario);
    EXPECT_EQ(scenario.receivers[0].baud, std::nullopt);
    EXPECT_EQ(scenario.receivers[1].baud, 57600U) << "a simulation sends the same bytes";
}

TEST(Wires, WithoutANameItIsUart1WhereverTheBoardListsIt) {
    using firmware::PortId;
    EXPECT_EQ(default_port(board_with({PortId::i2c, PortId::uart1, PortId::usb})), PortId::uart1);
    EXPECT_EQ(default_port(board_with({PortId::i2c, PortId::usb})), PortId::i2c);
}

// On a board that may have a port before it.
TEST(Stations, ARecordingWithoutWiresIsOfUart1) {
    const test::TemporaryFolder folder;
    const Scenario scenario = emulator_scenario("[run]\nstart = 2024-03-05T12:00:00Z");
    const GpsTime start = *scenario.run.start;
    Station::Parts parts = test::station_parts(scenario, 0, start);
    parts.recorder = std::move(test::recorder_in(folder / "run").value());
    std::vector<Station> stations;
    stations.emplace_back(std::move(parts));
    Emulator emulator({std::move(stations), std::make_unique<VirtualPacer>(start)}, start);
    emulator.run_until(start + 5s, stations_never_stop);
    EXPECT_THAT(content_of(folder / "run/port0.out"), HasSubstr("RMC,12000"));
}

const std::string two_receivers =
    "[run]\nstart = 2024-03-05T12:00:00Z\nduration_s = 30\n"
    "[trajectory]\nkind = \"circle\"\ncentre = [46.5, 30.75, 50]\nradius_m = 30\nspeed_mps = 4\n"
    "[[receiver]]\nname = \"front\"\nantenna_offset_m = [0.5, 0, 0]\n"
    "[[receiver]]\nname = \"rear\"\nantenna_offset_m = [-0.5, 0, 0]\n";

Assembly stations_assembly(const std::string& text, std::optional<std::filesystem::path> record = std::nullopt) {
    RunMode mode;
    mode.virtual_time = true;
    mode.open_ports = false;
    mode.record = std::move(record);
    auto assembly = assemble(emulator_scenario(text), test::emulator_data(), mode);
    EXPECT_TRUE(assembly) << assembly.error().message;
    EXPECT_TRUE(!assembly || assembly->emulator->begin());
    return assembly ? std::move(*assembly) : Assembly{};
}

// The traces of each receiver.
std::map<std::size_t, std::vector<Trace>> traces_of(Assembly& assembly) {
    std::map<std::size_t, std::vector<Trace>> traces;
    assembly.emulator->on_status([&](const Status& status) { traces[status.station].push_back(*status.trace); });
    assembly.emulator->run_until(*assembly.end, stations_never_stop);
    return traces;
}

TEST(Stations, EachReceiverHasItsOwnAntennaAndRate) {
    Assembly assembly = stations_assembly(two_receivers + "rate_hz = 5\n");
    auto traces = traces_of(assembly);
    ASSERT_EQ(traces[0].size(), 30U);
    ASSERT_EQ(traces[1].size(), 150U);
    for (std::size_t i = 0; i < 30; ++i) {
        ASSERT_EQ(traces[0][i].truth.time, traces[1][5 * i].truth.time) << "one clock";
        EXPECT_NEAR((traces[0][i].truth.position - traces[1][5 * i].truth.position).length().value(), 1, 1e-4);
    }
    EXPECT_EQ(assembly.emulator->stations()[1].counts().epochs, 150U);
    EXPECT_EQ(assembly.emulator->stations()[1].receiver().counters().epochs, 150U);
}

// What the antennas of one vehicle share, and what they do not.
TEST(Stations, TheWorldIsOneAndTheNoiseIsNot) {
    Assembly assembly = stations_assembly(two_receivers);
    auto traces = traces_of(assembly);
    const Trace &front = traces[0].back(), &rear = traces[1].back();
    ASSERT_EQ(front.arrivals.satellites.size(), rear.arrivals.satellites.size());
    for (std::size_t i = 0; i < front.arrivals.satellites.size(); ++i) {
        const Arrival &a = front.arrivals.satellites[i], &b = rear.arrivals.satellites[i];
        EXPECT_NEAR(a.signal_in_space_error.value(), b.signal_in_space_error.value(), 1e-3);
        EXPECT_NEAR(a.iono_delay.value(), b.iono_delay.value(), 1e-2);
    }
    EXPECT_GT((to_ecef(front.epoch.fix.position) - to_ecef(rear.epoch.fix.position)).length().value(), 1e-3);
    EXPECT_NE(front.epoch.fix.clock_bias.value(), rear.epoch.fix.clock_bias.value()) << "another oscillator";
}

std::string first_fixes(const std::string& text) {
    const test::TemporaryFolder folder;
    Assembly assembly = stations_assembly(text, folder / "run");
    assembly.emulator->run_until(*assembly.end, stations_never_stop);
    return content_of(folder / "run/fixes.csv");
}

TEST(Stations, ASecondReceiverLeavesTheFirstAsItWas) {
    const std::string alone = two_receivers.substr(0, two_receivers.find("[[receiver]]\nname = \"rear\""));
    EXPECT_EQ(first_fixes(two_receivers), first_fixes(alone));
    EXPECT_EQ(first_fixes(two_receivers), first_fixes(two_receivers)) << "and it is the same each time";
}

TEST(Stations, TheRecordingOfTheSecondLiesInAFolderOfItsOwn) {
    const test::TemporaryFolder folder;
    const auto scenario = emulator_scenario(two_receivers);
    Assembly assembly = stations_assembly(two_receivers, folder / "run");
    assembly.emulator->run_until(*assembly.end, stations_never_stop);
    for (const char* file : {"run/fixes.csv", "run/receiver1/fixes.csv"})
        EXPECT_EQ(lines_of(content_of(folder / file)).size(), 31U);
    EXPECT_NE(content_of(folder / "run/fixes.csv"), content_of(folder / "run/receiver1/fixes.csv"));
    EXPECT_GT(content_of(folder / "run/receiver1/port0.out").size(), 1000U);
    const auto summary = nlohmann::json::parse(run_summary(scenario, assembly, "1"));
    ASSERT_EQ(summary["receivers"].size(), 2U);
    EXPECT_EQ(summary["receivers"][1]["name"], "rear");
    EXPECT_EQ(summary["receivers"][1]["epochs"], 30);
    EXPECT_THAT(std::string(summary["receivers"][1]["folder"]), testing::EndsWith("run/receiver1"));
}

TEST(Stations, MistakesAndWarningsNameTheReceiver) {
    const auto refused =
        assemble(emulator_scenario(two_receivers + "port = \"uart9=pty\"\n"), test::emulator_data(), {});
    ASSERT_FALSE(refused);
    EXPECT_THAT(refused.error().message, testing::HasSubstr(": receiver.port: port 'uart9=pty'"));
    EXPECT_THAT(refused.error().message, testing::StartsWith("test.toml:")) << "its place tells which one";
    EXPECT_THAT(
        stations_assembly(two_receivers + "rate_hz = 90\n").warnings,
        testing::Contains(testing::MatchesRegex("test.toml:[0-9]+:11: receiver.rate_hz: 90 Hz is more than.*")));
}

// Heading of the vector from base to rover, and of the truth; degrees apart.
double heading_error(const Trace& base, const Trace& rover) {
    const Eigen::Vector3d truth =
        LocalFrame(base.truth.geodetic).to_enu(rover.truth.position - base.truth.position).vector();
    const double solved = std::atan2(rover.epoch.relative->east_m, rover.epoch.relative->north_m);
    return std::remainder(solved - std::atan2(truth.x(), truth.y()), 2 * M_PI) * 180 / M_PI;
}

// Of two F9P that see GPS alone; the half cycle of a phase takes six seconds to be known.
const std::string pair_of_two_bands = two_receivers + "board = \"ublox-f9p\"\n";

TEST(Stations, ARoverKnowsTheHeadingOfItsVehicle) {
    std::string text = pair_of_two_bands;
    text.replace(text.find("duration_s = 30"), 15, "duration_s = 300");
    // The rover comes first: the order of the receivers makes no difference.
    text.insert(text.find("antenna_offset_m = [0.5"), "board = \"ublox-f9p\"\nbase = \"rear\"\n");
    Assembly assembly = stations_assembly(text);
    auto traces = traces_of(assembly);
    ASSERT_EQ(traces[0].size(), 300U);
    double squares = 0;
    int fixed = 0;
    for (std::size_t i = 8; i < traces[0].size(); ++i) {
        const Trace &rover = traces[0][i], &base = traces[1][i];
        EXPECT_FALSE(base.epoch.relative);
        ASSERT_TRUE(rover.epoch.relative) << i;
        EXPECT_EQ(rover.epoch.fix.type, rover.epoch.relative->fixed ? FixType::rtk_fixed : FixType::rtk_float);
        EXPECT_NE(base.epoch.fix.type, FixType::rtk_fixed);
        if (!rover.epoch.relative->fixed) continue;
        ++fixed;
        squares += std::pow(heading_error(base, rover), 2);
        EXPECT_NEAR(std::hypot(rover.epoch.relative->north_m, rover.epoch.relative->east_m), 1, 0.03);
        EXPECT_GT(rover.epoch.relative->down_deviation, rover.epoch.relative->deviation);
    }
    EXPECT_GT(fixed, 200);
    EXPECT_LT(std::sqrt(squares / fixed), 0.5);
    EXPECT_GT(std::sqrt(squares / fixed), 0.05) << "it is not the truth itself";
}

TEST(Stations, ThereIsNoVectorWithoutAnEpochOfTheBase) {
    std::string text = pair_of_two_bands + "base = \"front\"\nrate_hz = 2\n";
    text.insert(text.find("antenna_offset_m = [0.5"), "board = \"ublox-f9p\"\n");
    Assembly assembly = stations_assembly(text);
    auto traces = traces_of(assembly);
    ASSERT_EQ(traces[1].size(), 60U);
    for (std::size_t i = 16; i < traces[1].size(); ++i) {
        const Trace& trace = traces[1][i];
        const bool base_too = trace.truth.time.time_since_epoch() % 1s == 0ns;
        EXPECT_EQ(trace.epoch.relative.has_value(), base_too);
        EXPECT_GE(trace.epoch.fix.type, FixType::rtk_float) << i;
        if (!base_too) {
            EXPECT_EQ(trace.epoch.fix.type, traces[1][i - 1].epoch.fix.type) << i << ": the last one stays";
        }
    }
}

TEST(Stations, EachWireHearsItsOwnPort) {
    const test::TemporaryFolder folder;
    const Scenario scenario = emulator_scenario("[run]\nstart = 2024-03-05T12:00:00Z");
    const GpsTime start = *scenario.run.start;
    Station::Parts parts = test::station_parts(scenario, 0, start);
    std::vector<MemoryTransport*> wires;
    for (const firmware::PortId port : {firmware::PortId::usb, firmware::PortId::uart1, firmware::PortId::uart1}) {
        auto transport = std::make_unique<MemoryTransport>();
        wires.push_back(transport.get());
        parts.wires.push_back({port, Link(std::move(transport), port_speed(parts.receiver, port))});
    }
    parts.recorder = std::move(test::recorder_in(folder / "run", 3).value());
    std::vector<Station> stations;
    stations.emplace_back(std::move(parts));
    Emulator emulator({std::move(stations), std::make_unique<test::TickingPacer>(start, 1ms)}, start);
    wires[2]->feed(to_bytes("hello"));
    emulator.run_until(start + 3s, stations_never_stop);
    EXPECT_GT(wires[1]->written().size(), 500U);
    EXPECT_EQ(wires[1]->written(), wires[2]->written());
    EXPECT_EQ(wires[0]->receiver_baud(), 0U) << "USB has no line speed";
    EXPECT_EQ(wires[1]->receiver_baud(), 9600U);
    EXPECT_EQ(content_of(folder / "run/port1.out"), to_string(ByteSpan(wires[1]->written())));
    EXPECT_EQ(content_of(folder / "run/port0.out"), to_string(ByteSpan(wires[0]->written())));
    EXPECT_EQ(content_of(folder / "run/port2.in"), "hello");
    EXPECT_EQ(content_of(folder / "run/port1.in"), "");
}

}  // namespace
}  // namespace skyloop
