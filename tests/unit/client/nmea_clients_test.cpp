#include "client_bench.hpp"

namespace skyloop::test {
namespace {

using std::chrono::milliseconds;
using std::chrono::seconds;

/// The sentences of one epoch.
struct BenchSentences {
    explicit BenchSentences(GpsTime now) {
        const UtcTime utc = rounded_utc(now, 2, LeapSeconds::announced());
        const double since = difference(now, bench_start).value();
        gga.time = rmc.time = nmea_time(utc);
        rmc.date = nmea_date(utc);
        gga.position = rmc.position = NmeaPosition{Angle::degrees(47.4 + since * 10 / 111'195.0), Angle::degrees(8.5)};
        gga.quality = 1;
        gga.satellites_used = 12;
        gga.hdop = 0.8;
        gga.altitude = Metres(450);
        gga.geoid_separation = Metres(48);
        rmc.valid = true;
        rmc.speed = MetresPerSecond(10);
        rmc.course = Angle::degrees(0);
        rmc.mode = NmeaMode::autonomous;
    }
    Gga gga;
    Rmc rmc;
};

class NmeaBench {
public:
    explicit NmeaBench(std::string_view name) : bench(name) {}
    std::function<void(BenchSentences&)> edit{};

    void run(Nanoseconds span) {
        for (const GpsTime end = bench.now + span; bench.now < end;) {
            bench.pass(milliseconds(200));
            BenchSentences sentences(bench.now);
            if (edit) edit(sentences);
            if (bench.speed() != speed) continue;
            bench.say(ByteSpan(to_bytes(encode(sentences.rmc, NmeaFormat{}) + encode(sentences.gga, NmeaFormat{}))));
        }
    }
    ClientBench bench;
    std::uint32_t speed = 38400;
};

TEST(CarefulNmea, FindsTheSpeedAndTrusts) {
    NmeaBench run("careful-nmea");
    run.run(seconds(12));
    EXPECT_TRUE(run.bench.trusts()) << run.bench.reason();
    EXPECT_TRUE(run.bench.heard.empty()) << "it spoke";
}

struct WrongSentences {
    const char* name;
    std::function<void(BenchSentences&)> edit;
    const char* reason;
};
class CarefulNmeaDoubts : public ::testing::TestWithParam<WrongSentences> {};

TEST_P(CarefulNmeaDoubts, OnceAndUntilItIsOver) {
    NmeaBench run("careful-nmea");
    run.run(seconds(12));
    ASSERT_TRUE(run.bench.trusts()) << run.bench.reason();
    run.edit = GetParam().edit;
    run.run(seconds(4));
    ASSERT_FALSE(run.bench.trusts());
    EXPECT_NE(run.bench.reason().find(GetParam().reason), std::string::npos) << run.bench.reason();
    run.edit = nullptr;
    run.run(seconds(25));
    EXPECT_TRUE(run.bench.trusts()) << run.bench.reason();
}

const WrongSentences wrong_sentences[] = {
    {"StalePosition", [](BenchSentences& s) { s.gga.quality = 0; }, "fix"},
    {"StatusAgainstQuality", [](BenchSentences& s) { s.rmc.valid = false; }, "fix"},
    {"Estimated", [](BenchSentences& s) { s.gga.quality = 6; }, "fix"},
    {"FewSatellites", [](BenchSentences& s) { s.gga.satellites_used = 4; }, "4 satellites"},
    {"Dop", [](BenchSentences& s) { s.gga.hdop = 3.5; }, "HDOP 3.5"},
    {"NoPosition", [](BenchSentences& s) { s.gga.position.reset(); }, "without a position"},
    {"NoRmc",
     [](BenchSentences& s) {
         s.rmc.time = NmeaTime{1, 2, 3, 0};
     },
     "no GGA and RMC"},
    {"Step", [](BenchSentences& s) { s.gga.position->longitude = Angle::degrees(8.501); }, "positions moved"},
    {"OldDate",
     [](BenchSentences& s) {
         s.rmc.date = NmeaDate{2006, 7, 16};
     },
     "date before"},
};
INSTANTIATE_TEST_SUITE_P(Each, CarefulNmeaDoubts, ::testing::ValuesIn(wrong_sentences),
                         [](const auto& tested) { return std::string(tested.param.name); });

TEST(NaiveNmea, TakesAnyPosition) {
    NmeaBench run("naive-nmea");
    run.speed = 9600;
    run.edit = [](BenchSentences& s) { s.gga.quality = 0; };
    run.run(seconds(1));
    EXPECT_TRUE(run.bench.trusts());
    run.edit = [](BenchSentences& s) { s.gga.position.reset(); };
    run.run(seconds(1));
    EXPECT_FALSE(run.bench.trusts());
}

}  // namespace
}  // namespace skyloop::test
