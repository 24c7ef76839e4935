// What SBAS satellites send, against the errors that the run itself makes.
#include "world/sbas/sbas_services.hpp"

#include <gtest/gtest.h>

#include <chrono>
#include <cmath>
#include <map>
#include <set>

#include "base/geo/local_frame.hpp"
#include "receiver/pvt/sbas_data.hpp"
#include "support/oracle_table.hpp"
#include "world/gnss/constants.hpp"
#include "world/gnss/navigation_data.hpp"
#include "world/gnss/nominal_sky.hpp"
#include "world/propagation/ionosphere_effects.hpp"
#include "world/propagation/signal_in_space_error.hpp"
#include "world/rinex/navigation_file.hpp"
#include "world/rinex/precise_orbit_file.hpp"
#include "world/sky/observe_sky.hpp"

namespace skyloop {
namespace {

using namespace std::chrono_literals;

const GpsTime first_heard = to_gps_time(2243, 3600.0 * 10.5);
const Geodetic munich = Geodetic::degrees(48.1, 11.5, 600), athens = Geodetic::degrees(38, 23.7, 100);
constexpr SatelliteId egnos{Constellation::sbas, 36}, other_egnos{Constellation::sbas, 23},
    waas{Constellation::sbas, 31}, tested{Constellation::sbas, 26}, foreign{Constellation::sbas, 30};

struct World {
    World() {
        context.run = {first_heard, first_heard + 1h};
        context.receiver_correction = IonosphereModel::ntcm_g;  // the truth's own, so that the day departs from it
        context.seed = 5;
    }
    [[nodiscard]] std::unique_ptr<SbasSource> services() const {
        return std::move(*sbas_services({navigation, parameters, context, munich}));
    }

    std::shared_ptr<const NavigationSource> navigation =
        std::make_shared<NominalSky>(std::vector{Constellation::gps, Constellation::sbas});
    ModernPropagationParameters parameters;
    ModernContext context;
};

SbasMessage message_at(SbasSource& source, SatelliteId satellite, GpsTime end) {
    const auto words = source.message(satellite, end);
    EXPECT_TRUE(words);
    const auto message = decode_sbas({words->begin(), words->end()});
    EXPECT_TRUE(message);
    return message.value_or(SbasNull{});
}

SbasData heard(SbasSource& source, SatelliteId satellite, GpsTime from, GpsTime until) {
    SbasData data;
    for (GpsTime end = from; end <= until; end += 1s) {
        const auto words = *source.message(satellite, end);
        data.hear({satellite, Signal::l1, end, 0, {words.begin(), words.end()}}, true);
    }
    return data;
}

TruthState antenna_at(const Geodetic& place, GpsTime time) { return {time, to_ecef(place), Velocity<Ecef>(), place}; }

// What is left of the errors of orbits and clocks at a place, m, by satellite.
std::map<SatelliteId, double> left_of_orbits(const World& world, const SbasData& data, const Geodetic& place,
                                             GpsTime time) {
    const TruthState truth = antenna_at(place, time);
    const SkyView sky = observe_sky(truth, *world.navigation, world.context.precise.get());
    Arrivals arrivals = free_space(sky);
    SignalInSpaceError(world.parameters.signal_in_space_model, world.parameters.signal_in_space, world.context.seed)
        .apply(arrivals, sky, truth);
    std::map<SatelliteId, double> left;
    for (std::size_t i = 0; i < sky.satellites.size(); ++i) {
        const SatelliteInView& s = sky.satellites[i];
        const auto told = data.correction(s.id, time);
        if (!told || s.iode != told->iode || s.elevation.deg() < 10) continue;
        const Eigen::Vector3d line = (s.position_at_transmission.vector() - truth.position.vector()).normalized();
        left[s.id] = arrivals.satellites[i].signal_in_space_error.value() - line.dot(told->orbit_m) +
                     speed_of_light * told->clock_s + told->range.value();
    }
    return left;
}

TEST(SbasServices, CorrectTheErrorsOfOrbitsAndClocks) {
    const World world;
    const auto services = world.services();
    const GpsTime now = first_heard + 90s;
    const SbasData data = heard(*services, egnos, first_heard, now);
    for (const Geodetic& place : {munich, athens, Geodetic::degrees(60, -20, 0), Geodetic::degrees(28, -15, 0)}) {
        const auto left = left_of_orbits(world, data, place, now);
        EXPECT_GE(left.size(), 5u);
        for (const auto& [id, metres] : left)
            EXPECT_LT(std::abs(metres), 0.25) << to_string(id);
    }
}

TEST(SbasServices, CorrectWhatTheRecordsOfADayGetWrong) {
    SKYLOOP_REQUIRE_SHARED(records, "nav/BRDC00IGS_R_20230010000_01D_MN.rnx.gz");
    SKYLOOP_REQUIRE_SHARED(orbits, "precise/COD0MGXFIN_20230010000_01D_05M_ORB.SP3.gz");
    const auto read = read_navigation_file(records);
    ASSERT_TRUE(read);
    World world;
    world.navigation = std::make_shared<NavigationData>(read->records, read->ionosphere, "a day");
    world.context.run = {first_heard, first_heard + 1h};
    world.context.precise =
        std::make_shared<PreciseTruth>(PreciseTruth::Parts{read_precise_orbit_file(orbits)->orbits});
    const auto services = world.services();
    const GpsTime now = first_heard + 90s;
    const SbasData data = heard(*services, egnos, first_heard, now);
    for (const Geodetic& place : {munich, athens}) {
        const auto left = left_of_orbits(world, data, place, now);
        EXPECT_GE(left.size(), 5u);
        for (const auto& [id, metres] : left)
            EXPECT_LT(std::abs(metres), 0.3) << to_string(id);
    }
}

TEST(SbasServices, TellTheIonosphereAsItIs) {
    const World world;
    const auto services = world.services();
    const GpsTime now = first_heard + 60s;
    const SbasData data = heard(*services, egnos, first_heard, now);
    ModernPropagationParameters parameters = world.parameters;
    auto effects = modern_effects(parameters, world.context);
    const TruthState truth = antenna_at(munich, now);
    const SkyView sky = observe_sky(truth, *world.navigation);
    Arrivals arrivals = free_space(sky);
    for (const auto& effect : *effects)
        effect->apply(arrivals, sky, truth);
    int checked = 0;
    double delays = 0, left = 0;
    for (const Arrival& a : arrivals.satellites) {
        if (a.id.constellation != Constellation::gps || a.direction.elevation.deg() < 15) continue;
        const auto told = data.ionosphere(munich, a.direction, now);
        ASSERT_TRUE(told) << to_string(a.id);
        ++checked;
        delays += a.iono_delay.value();
        left += std::abs((a.iono_delay - *told).value());
    }
    EXPECT_GE(checked, 5);
    EXPECT_LT(left, 0.15 * delays) << "of which 5 % are each satellite's own, and some the shell's height";
    EXPECT_FALSE(data.ionosphere(Geodetic::degrees(-16.5, -68.1, 3600), {Angle(), Angle::degrees(90)}, now));
}

TEST(SbasServices, NeedAMinuteToTellAllThatAPlaceNeeds) {
    const World world;
    const auto services = world.services();
    for (int start = 0; start < 45; start += 9) {
        const GpsTime from = first_heard + std::chrono::seconds(100 * start);
        const SbasData data = heard(*services, egnos, from, from + 60s);
        EXPECT_GE(left_of_orbits(world, data, munich, from + 60s).size(), 5u);
        EXPECT_TRUE(data.ionosphere(munich, {Angle(), Angle::degrees(90)}, from + 60s));
    }
}

TEST(SbasServices, SendTheSameWheneverTheyAreAsked) {
    const World world;
    const auto all = world.services(), late = world.services();
    int differ = 0;
    for (GpsTime end = first_heard; end < first_heard + 400s; end += 1s) {
        std::map<SatelliteId, SbasWords> sent;
        for (const SatelliteId id : {waas, other_egnos, egnos})
            sent[id] = *all->message(id, end);
        // Fast corrections are the same, the rest comes at other times.
        differ += sent.at(egnos) != sent.at(other_egnos) ? 1 : 0;
        if (end >= first_heard + 200s) {
            EXPECT_EQ(sent.at(egnos), *late->message(egnos, end));
        }
    }
    EXPECT_GT(differ, 190) << "of the 200 that are not fast corrections";
}

TEST(SbasServices, SendEveryTypeInTurn) {
    const World world;
    const auto services = world.services();
    std::map<SatelliteId, std::set<int>> types;
    for (GpsTime end = first_heard; end < first_heard + 120s; end += 1s)
        for (const SatelliteId id : {egnos, waas, tested, foreign})
            types[id].insert(sbas_message_type(message_at(*services, id, end)));
    const std::set<int> usual{1, 2, 3, 6, 7, 9, 10, 17, 18, 24, 25, 26, 27};
    EXPECT_EQ(types.at(egnos), usual);
    EXPECT_EQ(types.at(waas), usual);
    std::set<int> of_test = usual;
    of_test.erase(2);
    of_test.insert(0);
    EXPECT_EQ(types.at(tested), of_test);
    EXPECT_EQ(types.at(foreign), (std::set<int>{9, 63})) << "whose system is not emulated";
    EXPECT_FALSE(services->message({Constellation::sbas, 38}, first_heard + 120s)) << "which is not in the sky";
}

TEST(SbasServices, SpeakOfTheRecordsThatUsersHave) {
    const World world;
    const auto services = world.services();
    // When the first record of GPS changes.
    const SatelliteId any = world.navigation->satellites().front();
    GpsTime change = first_heard;
    const auto iode_at = [&](GpsTime time) { return iode_of(*world.navigation->ephemeris(any, time)); };
    while (iode_at(change) == iode_at(first_heard))
        change += 1s;
    std::map<int, std::pair<GpsTime, GpsTime>> told;  // by IODE: first and last
    for (GpsTime end = change - 120s; end < change + 400s; end += 1s) {
        const SbasMessage message = message_at(*services, egnos, end);
        if (const auto* m = std::get_if<SbasLongTermCorrections>(&message))
            for (const SbasLongTermHalf& half : m->halves)
                for (const SbasLongTermCorrection& c : half.satellites)
                    if (c.number > 0) told.try_emplace(c.iode, end, end).first->second.second = end;
    }
    const int before = iode_at(change - 1s) & 0xFF, after = iode_at(change) & 0xFF;
    ASSERT_TRUE(told.contains(before) && told.contains(after));
    EXPECT_LE(told.at(before).second, change + 12s);
    EXPECT_GT(told.at(after).first, change) << "as what is sent is seconds old";
    EXPECT_LT(told.at(after).first, change + 60s);
}

TEST(SbasServices, TellNothingOfErrorsThatAreSwitchedOff) {
    World world;
    world.parameters.signal_in_space.enabled = false;
    world.parameters.ionosphere.enabled = false;
    const auto services = world.services();
    const SbasData data = heard(*services, egnos, first_heard, first_heard + 90s);
    for (int prn = 1; prn <= 32; ++prn)
        if (const auto c = data.correction({Constellation::gps, prn}, first_heard + 90s)) {
            EXPECT_LT(c->orbit_m.norm(), 1e-9);
            EXPECT_EQ(c->range, Metres(0));
            EXPECT_EQ(c->udre_index, 0);
        }
    EXPECT_EQ(data.ionosphere(munich, {Angle(), Angle::degrees(40)}, first_heard + 90s), Metres(0));
}

TEST(SbasServices, AreNoneWithoutTheirSatellites) {
    World world;
    world.navigation = std::make_shared<NominalSky>(std::vector{Constellation::gps});
    EXPECT_FALSE(world.services());
}

}  // namespace
}  // namespace skyloop
