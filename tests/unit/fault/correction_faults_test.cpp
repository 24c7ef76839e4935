#include <gtest/gtest.h>

#include <cmath>
#include <map>
#include <string>
#include <vector>

#include "base/geo/geodetic.hpp"
#include "receiver/protocol/rtcm3.hpp"
#include "receiver/protocol/rtcm3_legacy.hpp"
#include "receiver/protocol/stream_splitter.hpp"
#include "run/fault/fault_kind.hpp"
#include "run/fault/wire_damage.hpp"
#include "wire_stream.hpp"

namespace skyloop {
namespace {

using Given = std::map<std::string, ParameterValue, std::less<>>;

const GpsTime corrections_start = to_gps_time(2400, 100000);
const Geodetic base_place = Geodetic::degrees(52.38, 13.07, 144);

GpsTime corrections_time(double seconds) { return advanced(corrections_start, Seconds(seconds)); }

Fault correction_fault(std::string_view name, Given given = {}) {
    const FaultKind* kind = find_fault_kind(name);
    if (kind == nullptr) throw std::runtime_error("no such kind");
    const CheckedParameters checked = check_parameters(kind->parameters, given);
    EXPECT_TRUE(checked.mistakes.empty());
    auto fault = kind->make(checked.parameters, {1, std::string(name)});
    if (!fault) throw std::runtime_error(fault.error().message);
    return std::move(*fault);
}

Rtcm3Station station_at(const Position<Ecef>& place) {
    Rtcm3Station station;
    station.station = 7;
    for (std::size_t axis = 0; axis < 3; ++axis)
        station.position[axis] = std::llround(place.vector()[static_cast<Eigen::Index>(axis)] * 1e4);
    return station;
}

Position<Ecef> place_of(const Rtcm3Station& station) {
    const auto at = [&](std::size_t axis) { return 1e-4 * static_cast<double>(station.position[axis]); };
    return {at(0), at(1), at(2)};
}

constexpr double told_range_m = 22e6;

// Eight satellites on two signals, at a second of the run.
Bytes msm_of(int number, int second) {
    Rtcm3MsmObservations message{number, 7, 0, number == 1077, {}};
    const double of_week = 100000 + second;
    message.epoch = static_cast<std::uint32_t>(of_week * 1000);
    if (number == 1087)
        message.epoch = static_cast<std::uint32_t>(std::fmod(of_week - 18 + 3 * 3600, 86400) * 1000) | 1u << 27;
    for (int satellite = 1; satellite <= 8; ++satellite)
        for (const int signal : {2, 15}) {
            Rtcm3MsmCell cell;
            cell.satellite = satellite;
            cell.signal = signal;
            cell.range_m = told_range_m;
            cell.phase_range_m = told_range_m;
            message.cells.push_back(cell);
        }
    return encode(message);
}

struct HeardFrame {
    double at_s;
    Bytes bytes;
    [[nodiscard]] Rtcm3Message message() const { return *parse_rtcm3(bytes); }
};

// A base that sends its place, GPS, GLONASS and biases each second; what a rover hears for so long under a fault that
// begins in the midst of an epoch. All else is told between them and comes as it was.
std::vector<HeardFrame> heard_corrections(const Fault& fault, int seconds) {
    WireDamage wire(3, "wire0.to_receiver");
    StreamSplitter splitter({true, true, true, true, true, true});
    std::vector<HeardFrame> heard;
    Bytes others;
    const auto hear = [&](double t) {
        for (StreamPiece& piece : splitter.feed(wire.take(corrections_time(t)))) {
            if (piece.kind == StreamKind::rtcm3)
                heard.push_back({t, std::move(piece.bytes)});
            else
                others.insert(others.end(), piece.bytes.begin(), piece.bytes.end());
        }
    };
    for (int second = 0; second < seconds; ++second) {
        const Bytes frames[] = {msm_of(1077, second), msm_of(1087, second), encode(station_at(to_ecef(base_place))),
                                encode(Rtcm3GlonassBiases{7, true, {}}), test::wire_message(second)};
        for (int tenth = 0; tenth < 10; ++tenth) {
            const double t = second + 0.1 * tenth;
            if (t > 0.05) {
                WireConditions conditions;
                FaultMoment moment;
                moment.now = corrections_time(t);
                fault.wire(conditions, moment);
                wire.set(conditions.to_receiver, moment.now);
            }
            if (tenth < 5) wire.put(frames[tenth], corrections_time(t));
            hear(t);
        }
    }
    EXPECT_TRUE(others == test::wire_messages(seconds));
    return heard;
}

std::vector<HeardFrame> of_number(const std::vector<HeardFrame>& all, int number) {
    std::vector<HeardFrame> found;
    for (const HeardFrame& frame : all)
        if (frame.message().number == number) found.push_back(frame);
    return found;
}

TEST(CorrectionFaults, ChangeNothingOfASoundRover) {
    const auto heard =
        heard_corrections(correction_fault("base_misplaced", {{"direction", std::string("to_client")}}), 3);
    ASSERT_EQ(heard.size(), 12U);
    EXPECT_EQ(heard[0].bytes, msm_of(1077, 0));
    EXPECT_EQ(heard[1].bytes, msm_of(1087, 0));
}

TEST(CorrectionFaults, ABaseIsMisplacedAlongTheGround) {
    const auto heard = of_number(heard_corrections(correction_fault("base_misplaced", {{"up_m", 5.0}}), 2), 1005);
    ASSERT_EQ(heard.size(), 2U);
    const Geodetic told = to_geodetic(place_of(*decode_station(heard[0].message())));
    EXPECT_NEAR((told.latitude - base_place.latitude).rad() * curvature_radii(base_place.latitude).meridian, 111, 0.01);
    EXPECT_NEAR(told.longitude.deg(), base_place.longitude.deg(), 1e-8);
    EXPECT_NEAR((told.height.above_ellipsoid - base_place.height.above_ellipsoid).value(), 5, 1e-3);
}

// Whatever else 1006 has stays: here its antenna's height and the bits that say that the station is not a real one.
TEST(CorrectionFaults, OfAPlaceOnlyTheCoordinatesChange) {
    Rtcm3Station station = station_at(to_ecef(base_place));
    station.antenna_height = 12345;
    Bytes frame = encode(station);
    Bytes body(frame.begin() + 3, frame.end() - 3);
    body[4] = static_cast<std::uint8_t>(body[4] ^ 0x40);  // DF141, the first of the four bits before the coordinates
    frame = encode_rtcm3(body);
    WireDamage wire(3, "wire0.to_receiver");
    WireConditions conditions;
    correction_fault("base_misplaced").wire(conditions, {});
    wire.set(conditions.to_receiver, corrections_start);
    wire.put(frame, corrections_start);
    const Bytes out = wire.take(corrections_start);
    const auto message = parse_rtcm3(out);
    ASSERT_TRUE(message);
    EXPECT_EQ(decode_station(*message)->antenna_height, 12345);
    EXPECT_NE(decode_station(*message)->position, station.position);
    EXPECT_EQ(message->payload[4] & 0xC0, body[4] & 0xC0);
}

// EUREF Technical Note 1 (Altamimi 2018), table 3: ITRF2014 to ETRF2000 at 2010.0, and rates for a year.
TEST(CorrectionFaults, ANationalFrameIsThatOfItsService) {
    const auto heard = of_number(heard_corrections(correction_fault("base_in_other_frame"), 1), 1005);
    ASSERT_EQ(heard.size(), 1U);
    const double years = 1980.0137 + difference(corrections_start, GpsTime{}).value() / (365.25 * 86400) - 2010;
    const Eigen::Vector3d from = to_ecef(base_place).vector();
    const Eigen::Vector3d shift(54.7 + 0.1 * years, 52.2 + 0.1 * years, -74.1 - 1.9 * years);
    const Eigen::Vector3d turn(1.701 + 0.081 * years, 10.290 + 0.490 * years, -16.632 - 0.792 * years);
    const double scale = (2.12 + 0.11 * years) * 1e-9, mas = 4.84813681109536e-9;
    const Eigen::Vector3d expected = from + 1e-3 * shift + scale * from + mas * turn.cross(from);
    const Eigen::Vector3d told = place_of(*decode_station(heard[0].message())).vector();
    EXPECT_LT((told - expected).norm(), 2e-3);
    EXPECT_GT((told - from).norm(), 0.5);
}

TEST(CorrectionFaults, RareOnesComeAsWholeEpochs) {
    const auto heard = heard_corrections(correction_fault("corrections_rare", {{"period_s", 10.0}}), 60);
    const auto gps = of_number(heard, 1077), glonass = of_number(heard, 1087);
    ASSERT_GE(gps.size(), 6U);
    EXPECT_LE(gps.size(), 7U);
    EXPECT_EQ(of_number(heard, 1005).size(), 60U);
    for (std::size_t i = 1; i < gps.size(); ++i) {
        EXPECT_GE(gps[i].at_s - gps[i - 1].at_s, i == 1 ? 9 : 9.95);
        EXPECT_NEAR(glonass[glonass.size() - i].at_s, gps[gps.size() - i].at_s + 0.1, 0.01);
    }
}

TEST(CorrectionFaults, FrozenOnesRepeatOneWholeEpoch) {
    const auto heard = heard_corrections(correction_fault("corrections_frozen"), 20);
    for (const int number : {1077, 1087}) {
        const auto frames = of_number(heard, number);
        ASSERT_EQ(frames.size(), 20U);
        for (std::size_t i = 1; i < frames.size(); ++i)
            EXPECT_EQ(frames[i].bytes, msm_of(number, 1)) << i;
    }
}

TEST(CorrectionFaults, LateOnesComeInTheirOrder) {
    const auto heard = heard_corrections(correction_fault("corrections_late", {{"delay_s", 4.0}}), 10);
    const auto gps = of_number(heard, 1077);
    ASSERT_EQ(gps.size(), 6U);  // that of before the fault, and those of 1 to 5 s
    for (int i = 1; i < 6; ++i) {
        EXPECT_EQ(gps[static_cast<std::size_t>(i)].bytes, msm_of(1077, i));
        EXPECT_NEAR(gps[static_cast<std::size_t>(i)].at_s, i + 4, 0.01);
    }
}

TEST(CorrectionFaults, LostOnesAndBiasesAreMissing) {
    EXPECT_EQ(heard_corrections(correction_fault("corrections_lost"), 10).size(), 1U);  // of before it began
    const auto half = heard_corrections(correction_fault("corrections_lost", {{"probability", 0.5}}), 250);
    EXPECT_NEAR(static_cast<double>(half.size()), 500, 60);
    const auto heard = heard_corrections(correction_fault("glonass_biases_missing"), 10);
    EXPECT_EQ(heard.size(), 30U);
    EXPECT_TRUE(of_number(heard, 1230).empty());
}

// Of each signal its own, of the size that was asked for, and slow.
TEST(CorrectionFaults, MultipathIsInCodesAndPhases) {
    const auto frames = of_number(heard_corrections(correction_fault("base_multipath"), 3000), 1077);
    ASSERT_EQ(frames.size(), 3000U);
    double code = 0, phase = 0, steps = 0, last = 0;
    int count = 0;
    for (std::size_t i = 1; i < frames.size(); ++i) {
        const auto told = decode_msm(frames[i].message());
        ASSERT_EQ(told->cells.size(), 16U);
        for (const Rtcm3MsmCell& cell : told->cells) {
            code += std::pow(cell.range_m - told_range_m, 2);
            phase += std::pow(*cell.phase_range_m - told_range_m, 2);
            ++count;
        }
        const double now = told->cells[0].range_m;
        if (i > 1) steps = std::max(steps, std::abs(now - last));
        last = now;
    }
    EXPECT_NEAR(std::sqrt(code / count), 2, 0.3);
    EXPECT_NEAR(std::sqrt(phase / count), 0.01, 0.0015);
    EXPECT_LT(steps, 0.5);
}

TEST(CorrectionFaults, OldObservablesTakePartToo) {
    Rtcm3LegacyObservables old{1004, 7, 100'000'000, false, {}};
    Rtcm3LegacySatellite satellite;
    satellite.l1.range_m = satellite.l1.phase_range_m = told_range_m;
    satellite.l2 = satellite.l1;
    old.satellites.push_back(satellite);
    WireDamage wire(3, "wire0.to_receiver");
    WireConditions conditions;
    correction_fault("base_multipath").wire(conditions, {});
    wire.set(conditions.to_receiver, corrections_start);
    wire.put(encode(old), corrections_start);
    const Bytes out = wire.take(corrections_start);
    const auto told = decode_legacy(*parse_rtcm3(out));
    ASSERT_TRUE(told);
    EXPECT_GT(std::abs(*told->satellites[0].l1.range_m - told_range_m), 0.02);
    EXPECT_GT(std::abs(*told->satellites[0].l2->range_m - *told->satellites[0].l1.range_m), 0.02);
}

}  // namespace
}  // namespace skyloop
