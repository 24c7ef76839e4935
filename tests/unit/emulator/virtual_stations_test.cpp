#include "run/emulator/virtual_stations.hpp"

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <chrono>
#include <cmath>
#include <map>

#include "base/geo/local_frame.hpp"
#include "receiver/protocol/nmea_messages.hpp"
#include "receiver/protocol/rtcm3.hpp"
#include "receiver/protocol/rtcm3_descriptors.hpp"
#include "receiver/protocol/stream_splitter.hpp"
#include "support/flat_geoid.hpp"
#include "support/four_systems.hpp"
#include "support/run_parts.hpp"

namespace skyloop {
namespace {

using namespace std::chrono_literals;
using testing::HasSubstr;

constexpr std::string_view run_text = "[run]\nstart = 2024-03-05T12:00:00Z\nseed = 5\n";
const Geodetic odessa = Geodetic::degrees(46.4775, 30.7326, 77);

// A client at a place, without an undulation where that is not given.
std::string gga_of(double latitude, double longitude, double msl_m, int quality = 1,
                   std::optional<double> undulation_m = 30) {
    Gga gga;
    gga.time = NmeaTime{};
    gga.position = NmeaPosition{Angle::degrees(latitude), Angle::degrees(longitude)};
    gga.quality = quality;
    gga.altitude = Metres(msl_m);
    if (undulation_m) gga.geoid_separation = Metres(*undulation_m);
    NmeaFormat format;
    format.coordinate_decimals = 7;
    format.limit_82 = false;
    return encode(gga, format);
}

double metres_apart(const Geodetic& a, const Geodetic& b) { return (to_ecef(a) - to_ecef(b)).length().value(); }

TEST(PlaceOfAClient, IsThatOfItsGga) {
    const auto place = client_place(gga_of(46.4775, -30.7326, 47.2));
    ASSERT_TRUE(place);
    EXPECT_NEAR(place->latitude.deg(), 46.4775, 1e-7);
    EXPECT_NEAR(place->longitude.deg(), -30.7326, 1e-7);
    EXPECT_NEAR(place->height.above_sea_level.value(), 47.2, 0.05);
    EXPECT_NEAR(on_ellipsoid(*place, nullptr).height.above_ellipsoid.value(), 77.2, 0.05);
}

TEST(PlaceOfAClient, HasTheGeoidOfTheRunWhereItTellsNone) {
    const auto geoid = test::flat_geoid(-20.5);
    ASSERT_TRUE(geoid);
    for (const std::optional<double> absurd : {std::optional<double>(), std::optional(900.0)}) {
        const auto place = client_place(gga_of(46, 30, 100, 1, absurd));
        ASSERT_TRUE(place);
        EXPECT_NEAR(on_ellipsoid(*place, &*geoid).height.above_ellipsoid.value(), 79.5, 0.06);
        EXPECT_NEAR(on_ellipsoid(*place, nullptr).height.above_ellipsoid.value(), 100, 0.06);
    }
}

TEST(PlaceOfAClient, IsNoneWithoutAFixOrWhereNobodyCouldBe) {
    EXPECT_FALSE(client_place(gga_of(46, 30, 100, 0)));
    EXPECT_FALSE(client_place(gga_of(46, 30, 1e6)));
    EXPECT_FALSE(client_place(gga_of(46, 30, -5000)));
    EXPECT_FALSE(client_place("$GPGGA,120000,9946.0,N,03000.0,E,1,08,1.0,10,M,30,M,,*7F"));
    EXPECT_FALSE(client_place("$GPGLL,4717.11,N,00833.91,E,092321,A*2F"));
    EXPECT_FALSE(client_place("nonsense"));
    EXPECT_TRUE(client_place(gga_of(0, 0, 0)));
}

TEST(PlaceOfAStation, IsMetresFromItsClient) {
    for (const double latitude : {-89.0, -46.0, -0.00001, 0.0, 12.3456, 46.4775, 85.0, 89.9})
        for (const double longitude : {-180.0, -73.0, 0.0, 30.7326, 179.99999})
            for (const double height : {-2.0, 77.0, 12003.1}) {
                const Geodetic client = Geodetic::degrees(latitude, longitude, height);
                const Geodetic station = station_place(client);
                const Eigen::Vector3d away = LocalFrame(client).to_enu(to_ecef(station)).vector();
                EXPECT_GT(std::hypot(away.x(), away.y()), 3.4) << latitude << " " << longitude;
                EXPECT_LT(std::hypot(away.x(), away.y()), 10.8) << latitude << " " << longitude;
                EXPECT_GT(away.x(), 0);
                EXPECT_GT(away.y(), 0);
                EXPECT_LT(std::abs(away.z()), 2.6);
            }
}

TEST(PlaceOfAStation, IsAPlaceAtThePolesToo) {
    for (const double latitude : {-90.0, -89.9999, 89.99, 89.9999, 90.0}) {
        const Geodetic client = Geodetic::degrees(latitude, 17, 2800);
        const Geodetic station = station_place(client);
        EXPECT_LE(std::abs(station.latitude.deg()), 89.99 + 1e-9);
        EXPECT_LT(metres_apart(client, station), 1200);
    }
}

VirtualSky sky_of(const Scenario& scenario, const NavigationSource& navigation) {
    auto sky = VirtualSky::of(scenario, {navigation, nullptr, scenario.run.start.value(), test::emulator_data()});
    EXPECT_TRUE(sky) << sky.error().message;
    return std::move(*sky);
}

TEST(VirtualSky, MeasuresWhatAReceiverOfTheRunWould) {
    const Scenario scenario = test::emulator_scenario(run_text);
    const test::FourSystems navigation;
    const VirtualSky sky = sky_of(scenario, navigation);
    EXPECT_EQ(sky.signals().size(), 3U + 3 + 4 + 2);
    const GpsTime begin = scenario.run.start.value();
    auto one = sky.antenna(odessa, 1), other = sky.antenna(odessa, 2);
    ASSERT_TRUE(one && other);
    EXPECT_EQ((*one)->position().vector(), to_ecef(odessa).vector());
    const Observations first = (*one)->observe(begin), second = (*other)->observe(begin);
    EXPECT_EQ(first.receive_time, begin);
    ASSERT_EQ(first.signals.size(), second.signals.size());
    ASSERT_GT(first.signals.size(), 40U);
    std::set<Constellation> systems;
    double squares = 0, count = 0;
    for (std::size_t i = 0; i < first.signals.size(); ++i) {
        const Observation &a = first.signals[i], &b = second.signals[i];
        systems.insert(a.satellite.constellation);
        ASSERT_TRUE(a.pseudorange && b.pseudorange) << to_string(a.satellite);
        EXPECT_NE(*a.pseudorange, *b.pseudorange) << "noise of its own";
        // Of signals below, and of GLONASS's slow code, the loops' own noise is metres.
        constexpr DbHz strong{42};
        if (a.cn0 < strong || a.satellite.constellation == Constellation::glonass) continue;
        squares += std::pow((*a.pseudorange - *b.pseudorange).value(), 2);
        ++count;
    }
    EXPECT_EQ(systems.size(), 4U);
    const double noise = std::sqrt(squares / 2 / count);
    EXPECT_GT(noise, 0.01);
    EXPECT_LT(noise, 0.25) << "no echoes";
}

// The same satellites, orbits and air as a receiver of the run has: apart from noise and clocks nothing is left.
TEST(VirtualSky, HasTheAirOfTheRunAndNotTheSurroundingsOfItsReceiver) {
    std::string text(run_text);
    text += "[trajectory]\nkind = \"fixed\"\nat = [46.4775, 30.7326, 77]\n";
    text += "[model.modern]\nsurroundings = \"residential\"\n[model.modern.interference]\njammer_to_signal_db = 20\n";
    for (const char* term : {"code_noise", "multipath", "receiver_clock"})
        text += fmt::format("[model.modern.terms.{}]\nenabled = false\n", term);
    const Scenario scenario = test::emulator_scenario(text);
    const GpsTime begin = scenario.run.start.value();
    const auto navigation = std::make_shared<test::FourSystems>();
    auto receiver = make_simulation(scenario, {navigation, nullptr, begin, test::emulator_data()});
    auto antenna = sky_of(scenario, *navigation).antenna(odessa, 1);
    ASSERT_TRUE(receiver && antenna);
    ReceiverSettings settings;
    settings.signals = {{Constellation::gps, Signal::l1}, {Constellation::galileo, Signal::l1}};
    std::map<SatelliteId, Observation> heard;
    for (const Observation& o : receiver->run(begin, settings).epoch.observations.signals)
        heard.emplace(o.satellite, o);
    ASSERT_GT(heard.size(), 3U);
    int compared = 0;
    for (const Observation& o : (*antenna)->observe(begin).signals) {
        const auto found = heard.find(o.satellite);
        if (found == heard.end() || o.signal != found->second.signal) continue;
        EXPECT_NEAR((*o.pseudorange - *found->second.pseudorange).value(), 0, 1) << to_string(o.satellite);
        EXPECT_GT(o.cn0, found->second.cn0) << "neither jammed nor below trees";
        ++compared;
    }
    EXPECT_EQ(static_cast<std::size_t>(compared), heard.size());
}

TEST(VirtualSky, IsRefusedWhereNothingMeasures) {
    const Scenario scenario = test::emulator_scenario(std::string(run_text) + "[model]\nname = \"baseline\"\n");
    const test::FourSystems navigation;
    const auto sky = VirtualSky::of(scenario, {navigation, nullptr, scenario.run.start.value(), {}});
    ASSERT_FALSE(sky);
    EXPECT_EQ(sky.error().code, ErrorCode::usage);
    EXPECT_THAT(sky.error().message, HasSubstr("expected model.name = \"modern\""));
}

struct StationsBench {
    explicit StationsBench(int msm = 7) {
        SourceRecord about;
        about.mount = "VRS";
        mount = stations->mount(about, msm);
    }
    // Lets a second pass in which one looks every 10 ms.
    void pass(int count) {
        for (int i = 0; i < 100 * count; ++i)
            stations->look(now += 10ms);
    }

    const Scenario scenario = test::emulator_scenario(run_text);
    const test::FourSystems navigation{};
    GpsTime begin = scenario.run.start.value();
    GpsTime now = begin;
    std::shared_ptr<VirtualStations> stations =
        std::make_shared<VirtualStations>(sky_of(scenario, navigation), 5, "1.2");
    std::shared_ptr<CorrectionsSource> mount;
};

struct Told {
    std::vector<int> numbers;
    std::set<int> stations;
    std::vector<Rtcm3Station> places;
};

Told told_in(const Bytes& bytes) {
    StreamSplitter splitter{StreamProtocols()};
    Told told;
    for (const StreamPiece& piece : splitter.feed(bytes)) {
        const auto message = parse_rtcm3(piece.bytes);
        EXPECT_TRUE(message);
        if (!message) continue;
        told.numbers.push_back(message->number);
        if (message->station) told.stations.insert(*message->station);
        if (const auto station = decode_station(*message)) told.places.push_back(*station);
    }
    return told;
}

Geodetic place_of(const Rtcm3Station& station) {
    const auto at = [&](std::size_t axis) { return 1e-4 * static_cast<double>(station.position[axis]); };
    return to_geodetic(Position<Ecef>(at(0), at(1), at(2)));
}

TEST(VirtualStations, BeginWithAPlace) {
    StationsBench bench;
    const auto client = bench.mount->open();
    ASSERT_TRUE(client);
    bench.pass(2);
    client->hear_position(gga_of(46.4775, 30.7326, 47, 0));
    bench.pass(2);
    EXPECT_TRUE(client->take().empty());
    client->hear_position(gga_of(46.4775, 30.7326, 47));
    bench.stations->look(bench.now += 500ms);
    EXPECT_TRUE(client->take().empty()) << "the next whole second is the first";
    bench.pass(1);
    const Told first = told_in(client->take());
    EXPECT_THAT(first.numbers, testing::ElementsAre(1006, 1008, 1033, 1230, 1077, 1087, 1097, 1127));
    EXPECT_EQ(first.stations.size(), 1U);
    ASSERT_EQ(first.places.size(), 1U);
    EXPECT_TRUE(first.places[0].computed);
    EXPECT_EQ(first.places[0].antenna_height, 0);
    const double apart = metres_apart(place_of(first.places[0]), Geodetic::degrees(46.4775, 30.7326, 77));
    EXPECT_GT(apart, 3.4);
    EXPECT_LT(apart, 11.2);
    bench.pass(1);
    EXPECT_THAT(told_in(client->take()).numbers, testing::ElementsAre(1077, 1087, 1097, 1127));
    bench.pass(10);
    const auto numbers = told_in(client->take()).numbers;
    EXPECT_EQ(std::count(numbers.begin(), numbers.end(), 1077), 10);
    EXPECT_EQ(std::count(numbers.begin(), numbers.end(), 1006), 1);
}

TEST(VirtualStations, TellTheSecondOfTheirEpoch) {
    StationsBench bench(4);
    const auto client = bench.mount->open();
    client->hear_position(gga_of(-33.8568, 151.2153, 5));
    bench.stations->look(bench.now += 10ms);
    for (int i = 1; i <= 3; ++i) {
        bench.pass(1);
        StreamSplitter splitter{StreamProtocols()};
        int heard = 0;
        for (const StreamPiece& piece : splitter.feed(client->take())) {
            const auto message = parse_rtcm3(piece.bytes);
            const auto epoch = message ? decode_msm(*message) : std::nullopt;
            if (!epoch || epoch->number != 1074) continue;
            ++heard;
            const auto since_sunday =
                (bench.begin + std::chrono::seconds(i)).time_since_epoch() % std::chrono::hours(7 * 24);
            EXPECT_EQ(std::chrono::milliseconds(epoch->epoch), since_sunday);
        }
        EXPECT_EQ(heard, 1);
    }
}

TEST(VirtualStations, StayUntilTheClientIsFarAway) {
    StationsBench bench;
    const auto client = bench.mount->open();
    const auto station_at = [&](const std::string& gga) {
        client->hear_position(gga);
        bench.pass(11);
        const Told told = told_in(client->take());
        EXPECT_FALSE(told.places.empty());
        return told.places.empty() ? Rtcm3Station{} : told.places.back();
    };
    const Rtcm3Station first = station_at(gga_of(46.4775, 30.7326, 47));
    EXPECT_EQ(station_at(gga_of(46.5175, 30.7326, 47)), first) << "4.4 km";
    EXPECT_EQ(station_at(gga_of(46.9, 30.7326, 47, 0)), first) << "no fix";
    EXPECT_EQ(station_at(gga_of(46.9, 30.7326, 1e6)), first) << "no place";
    const Rtcm3Station second = station_at(gga_of(46.5275, 30.7326, 47));  // 5.6 km
    EXPECT_NE(second.station, first.station);
    EXPECT_LT(metres_apart(place_of(second), Geodetic::degrees(46.5275, 30.7326, 77)), 11.2);
    EXPECT_EQ(station_at(gga_of(46.4975, 30.7326, 47)), second) << "from the new one it counts";
}

TEST(VirtualStations, AreOneForEachClientAndNoMoreThanSixteen) {
    StationsBench bench;
    std::vector<std::unique_ptr<CorrectionsStream>> clients;
    for (std::size_t i = 0; i < VirtualStations::most_clients; ++i) {
        clients.push_back(bench.mount->open());
        ASSERT_TRUE(clients.back());
        clients.back()->hear_position(gga_of(46 + 0.1 * static_cast<double>(i), 30, 10));
    }
    EXPECT_FALSE(bench.mount->open());
    bench.pass(3);
    std::set<int> numbers;
    for (const auto& client : clients) {
        const Told told = told_in(client->take());
        EXPECT_EQ(told.stations.size(), 1U);
        numbers.insert(told.stations.begin(), told.stations.end());
    }
    EXPECT_EQ(numbers.size(), clients.size());
    clients.pop_back();
    const auto late = bench.mount->open();
    ASSERT_TRUE(late);
    late->hear_position(gga_of(10, 10, 10));
    bench.pass(2);
    EXPECT_EQ(told_in(late->take()).stations.size(), 1U);
}

TEST(VirtualStations, ChangeOnceASecondAtMost) {
    StationsBench bench;
    const auto client = bench.mount->open();
    for (int i = 0; i < 300; ++i) {
        client->hear_position(gga_of(i % 2 == 0 ? 46 : 47, 30, 10));
        bench.stations->look(bench.now += 10ms);
    }
    bench.pass(1);
    const std::set<int> numbers = told_in(client->take()).stations;
    EXPECT_GE(numbers.size(), 2U);
    EXPECT_LE(numbers.size(), 4U);
    EXPECT_LE(*numbers.rbegin(), 4);
}

// Nobody waits for all of them, and none is left behind.
TEST(VirtualStations, ObserveOneAfterTheOther) {
    StationsBench bench;
    const auto one = bench.mount->open(), other = bench.mount->open();
    one->hear_position(gga_of(46, 30, 10));
    other->hear_position(gga_of(47, 31, 10));
    bench.stations->look(bench.now += 1ms);
    bench.stations->look(bench.now += 1ms);
    EXPECT_TRUE(bench.stations->look(bench.begin + 1s));
    EXPECT_TRUE(one->take().empty() != other->take().empty());
    EXPECT_TRUE(bench.stations->look(bench.begin + 1s + 1ms));
    EXPECT_FALSE(bench.stations->look(bench.begin + 1s + 2ms));
    one->take();
    other->take();
    EXPECT_TRUE(bench.stations->look(bench.begin + 2s + 600ms));
    EXPECT_FALSE(one->take().empty() || other->take().empty()) << "late: both";
}

TEST(VirtualStations, AreAnsweredAtTheEndsOfTheEarth) {
    StationsBench bench;
    for (const auto& [latitude, longitude] :
         {std::pair(0.0, 0.0), {90.0, 0.0}, {-90.0, 180.0}, {-17.0, -180.0}, {46.0, 179.99999}}) {
        const auto client = bench.mount->open();
        client->hear_position(gga_of(latitude, longitude, 20000));
        bench.pass(2);
        const Told told = told_in(client->take());
        EXPECT_FALSE(told.places.empty()) << latitude << " " << longitude;
        EXPECT_THAT(told.numbers, testing::Contains(1077));
    }
}

TEST(VirtualStations, AreANetworkThatWantsPositions) {
    const StationsBench bench;
    EXPECT_THAT(bench.mount->table_line(true), HasSubstr(";0.00;0.00;1;1;skyloop;none;B;N;0;"));
}

// The receivers of a run do not notice who hears virtual stations.
TEST(VirtualStations, LeaveTheBytesOfTheRunAsTheyAre) {
    const auto bytes_with = [](bool served) {
        const Scenario scenario =
            test::emulator_scenario(std::string(run_text) + "[[receiver]]\nboard = \"ublox-f9p\"\n");
        test::MemoryRunParts parts;
        parts.tick = 10ms;
        test::MemoryRun run = test::memory_run(scenario, std::move(parts));
        const auto stations =
            std::make_shared<VirtualStations>(sky_of(scenario, run.emulator->simulation().navigation()), 5, "1.2");
        const auto mount = stations->mount({}, 7);
        const auto client = mount->open();
        std::size_t heard = 0;
        if (served) {
            client->hear_position(gga_of(46.4775, 30.7326, 47));
            run.emulator->on_look([&](GpsTime now) {
                stations->look(now);
                heard += client->take().size();
            });
        }
        const std::atomic<bool> stop{false};
        run.emulator->run_until(run.start + 20s, stop);
        EXPECT_EQ(heard > 3000, served);
        return run.wire->written();
    };
    const auto alone = bytes_with(false);
    EXPECT_FALSE(alone.empty());
    EXPECT_EQ(bytes_with(true), alone);
}

}  // namespace
}  // namespace skyloop
