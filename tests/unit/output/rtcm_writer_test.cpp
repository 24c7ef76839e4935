// What --output rtcm-… sends of an epoch.
#include "run/output/rtcm_writer.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "epochs.hpp"
#include "receiver/protocol/rtcm3.hpp"
#include "receiver/protocol/rtcm3_descriptors.hpp"
#include "receiver/protocol/rtcm3_ephemeris.hpp"
#include "world/gnss/signal.hpp"

namespace skyloop {
namespace {

using testing::ElementsAre;
using testing::IsEmpty;

// One satellite of GPS by its record, one by an almanac.
class TwoRecords final : public NavigationSource {
public:
    explicit TwoRecords(GpsTime toe) {
        record_.satellite = {Constellation::gps, 7};
        record_.toe = record_.toc = toe;
        record_.sqrt_a = 5153.6;
        record_.iode = record_.iodc = 41;
        record_.accuracy_m = 2;
        almanac_ = record_;
        almanac_.satellite.number = 9;
        almanac_.message = NavigationMessage::almanac;
    }
    [[nodiscard]] std::vector<SatelliteId> satellites() const override {
        return {record_.satellite, almanac_.satellite};
    }
    [[nodiscard]] std::optional<Ephemeris> ephemeris(SatelliteId satellite, GpsTime) const override {
        if (satellite == record_.satellite) return record_;
        if (satellite == almanac_.satellite) return almanac_;
        return std::nullopt;
    }
    [[nodiscard]] const BroadcastIonosphere& ionosphere() const override { return ionosphere_; }
    [[nodiscard]] std::optional<TimeSpan> span() const override { return std::nullopt; }
    [[nodiscard]] std::string description() const override { return "two records"; }

private:
    KeplerEphemeris record_, almanac_;
    BroadcastIonosphere ionosphere_;
};

Observation observed_signal(SatelliteId satellite, Signal signal) {
    Observation o;
    o.satellite = satellite;
    o.signal = signal;
    o.carrier = carrier_frequency(signal);
    o.cn0 = DbHz(45);
    o.pseudorange = Metres(2.1e7);
    o.carrier_phase = 1.1e8;
    return o;
}

test::SampleEpoch measured_epoch(double after_start) {
    test::SampleEpoch epoch{Seconds(after_start)};
    epoch.state.epoch.observations.receive_time = epoch.trace.truth.time;
    epoch.state.epoch.fix.leap_seconds = 18;
    epoch.state.epoch.observations.signals = {
        observed_signal({Constellation::gps, 7}, Signal::l1), observed_signal({Constellation::gps, 9}, Signal::l1),
        observed_signal({Constellation::gps, 11}, Signal::l1), observed_signal({Constellation::glonass, 3}, Signal::g1),
        observed_signal({Constellation::beidou, 30}, Signal::b1i)};
    return epoch;
}

OutputSettings rtcm_settings(std::string_view options) {
    return *parse_output_uri("rtcm-tcp:2101" + std::string(options));
}

std::vector<Bytes> told_by(const EpochWriter& writer, const test::SampleEpoch& epoch) {
    return writer(epoch.seen(), "only", 0)();
}

std::vector<int> numbers_in(const std::vector<Bytes>& frames) {
    std::vector<int> numbers;
    for (const Bytes& frame : frames)
        numbers.push_back(parse_rtcm3(frame)->number);
    return numbers;
}

TEST(RtcmWriter, TellsAllAtFirstAndThenEachAtItsPace) {
    const TwoRecords source(measured_epoch(0).trace.truth.time);
    const EpochWriter writer = make_rtcm_writer(rtcm_settings(",every_s=2,ephemerides_s=6"), {&source, "1.2"});
    EXPECT_THAT(numbers_in(told_by(writer, measured_epoch(0))),
                ElementsAre(1006, 1008, 1033, 1230, 1077, 1087, 1127, 1019, 1019));
    EXPECT_THAT(numbers_in(told_by(writer, measured_epoch(1))), ElementsAre(1077, 1087, 1127));
    EXPECT_THAT(numbers_in(told_by(writer, measured_epoch(2))), ElementsAre(1006, 1008, 1033, 1230, 1077, 1087, 1127));
    // An epoch that does not come does not keep the next one from its turn.
    EXPECT_THAT(numbers_in(told_by(writer, measured_epoch(7))),
                ElementsAre(1006, 1008, 1033, 1230, 1077, 1087, 1127, 1019, 1019));
}

TEST(RtcmWriter, TheStationStandsWhereTheAntennaTrulyIs) {
    const EpochWriter writer = make_rtcm_writer(rtcm_settings(",station=77,msm=5"), {nullptr, "1.2"});
    const test::SampleEpoch epoch = measured_epoch(0);
    const std::vector<Bytes> frames = told_by(writer, epoch);
    EXPECT_THAT(numbers_in(frames), ElementsAre(1006, 1008, 1033, 1230, 1075, 1085, 1125)) << "nobody knows records";
    const auto station = decode_station(*parse_rtcm3(frames[0]));
    ASSERT_TRUE(station);
    EXPECT_EQ(station->station, 77);
    EXPECT_EQ(station->antenna_height, 0);
    for (int i = 0; i < 3; ++i)
        EXPECT_NEAR(static_cast<double>(station->position[static_cast<std::size_t>(i)]) * 1e-4,
                    epoch.trace.truth.position.vector()[i], 1e-4)
            << "not where the fix is, 2 m off";
    EXPECT_EQ(*decode_descriptors(*parse_rtcm3(frames[2])),
              (Rtcm3Descriptors{1033, 77, "ADVNULLANTENNA", 0, "", "SKYLOOP", "1.2", ""}));
    const auto biases = decode_glonass_biases(*parse_rtcm3(frames[3]));
    EXPECT_TRUE(biases->aligned);
    EXPECT_EQ(biases->bias[0], 0);
    EXPECT_EQ(biases->bias[2], 0);
    const auto first = decode_msm(*parse_rtcm3(frames[4])), last = decode_msm(*parse_rtcm3(frames[6]));
    EXPECT_EQ(first->cells.size(), 3U);
    EXPECT_EQ(first->station, 77);
    EXPECT_TRUE(first->more);
    EXPECT_FALSE(last->more);
}

TEST(RtcmWriter, RecordsAreThoseOfTheBroadcast) {
    const test::SampleEpoch epoch = measured_epoch(0);
    const TwoRecords source(epoch.trace.truth.time);
    const EpochWriter writer = make_rtcm_writer(rtcm_settings(""), {&source, ""});
    const std::vector<Bytes> frames = told_by(writer, epoch);
    ASSERT_EQ(frames.size(), 9U);
    const auto record = decode_ephemeris(*parse_rtcm3(frames[7]), epoch.trace.truth.time);
    const auto of_almanac = decode_ephemeris(*parse_rtcm3(frames[8]), epoch.trace.truth.time);
    ASSERT_TRUE(record && of_almanac);
    EXPECT_EQ(iode_of(*record), 41);
    EXPECT_EQ(satellite_of(*of_almanac).number, 9);
    EXPECT_TRUE(is_healthy(*of_almanac));
}

TEST(RtcmWriter, SaysNothingWhenTheReceiverSaysNothing) {
    const EpochWriter writer = make_rtcm_writer(rtcm_settings(""), {});
    test::SampleEpoch mute = measured_epoch(0), timeless = measured_epoch(0);
    mute.leaves.reset();
    timeless.state.time = {};
    EXPECT_THAT(told_by(writer, mute), IsEmpty());
    EXPECT_THAT(told_by(writer, timeless), IsEmpty());
    EXPECT_EQ(numbers_in(told_by(writer, measured_epoch(1))).front(), 1006) << "the first that it says";
}

}  // namespace
}  // namespace skyloop
