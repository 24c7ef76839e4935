// One file of every format of receivers' output: compare and trajectory see the same epochs in it.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cstdio>
#include <functional>

#include "base/core/files.hpp"
#include "motion/tracks/read_track.hpp"
#include "motion/trajectory/track.hpp"
#include "receiver/observed/observed_log.hpp"
#include "receiver/protocol/sbf_blocks.hpp"
#include "receiver/protocol/sbf_cartesian_blocks.hpp"
#include "receiver/protocol/ubx_inertial.hpp"
#include "receiver/protocol/ubx_nav.hpp"
#include "study/analysis/fix_series.hpp"
#include "support/flat_geoid.hpp"
#include "support/log_bytes.hpp"
#include "support/oracle_table.hpp"

namespace skyloop {
namespace {

constexpr std::uint32_t first_ms = 216'018'000;  // 2024-03-05T12:00:00Z of GPS week 2304
constexpr unsigned epochs = 60;

// Text or bytes of sixty epochs, one a second, made epoch by epoch.
std::string sixty(const std::function<std::string(unsigned)>& epoch) {
    std::string whole;
    for (unsigned i = 0; i < epochs; ++i)
        whole += epoch(i);
    return whole;
}

std::string nav_pvat(unsigned i) {
    NavPvat m;
    m.i_tow = first_ms + 1000 * i, m.valid = 7, m.year = 2024, m.month = 3, m.day = 5, m.hour = 12;
    m.second = static_cast<std::uint8_t>(i);
    m.fix_type = 3, m.flags = 0x1D, m.num_sv = 11;
    m.lat = 470000000 + 10 * static_cast<int>(i), m.lon = 80000000, m.height = 500000;
    return to_string(encode_frame(m));
}

std::string nav_pvt(unsigned i) {
    NavPvt m;
    m.i_tow = first_ms + 1000 * i, m.valid = 7, m.year = 2024, m.month = 3, m.day = 5, m.hour = 12;
    m.second = static_cast<std::uint8_t>(i);
    m.fix_type = 3, m.flags = 1, m.num_sv = 11;
    m.lat = 470000000 + 10 * static_cast<int>(i), m.lon = 80000000, m.height = 500000;
    return to_string(encode_frame(m));
}

std::string nav_sol_and_posllh(unsigned i) {
    NavSol sol;
    sol.i_tow = first_ms + 1000 * i, sol.week = 2304, sol.gps_fix = 3, sol.flags = 0x0D, sol.num_sv = 7;
    NavPosllh llh;
    llh.i_tow = sol.i_tow, llh.lat = 470000000 + 10 * static_cast<int>(i), llh.lon = 80000000, llh.height = 500000;
    return to_string(encode_frame(sol)) + to_string(encode_frame(llh));
}

template <class Block>
std::string sbf_block(const Block& block) {
    return to_string(encode_sbf_block(Block::block_number, Block::block_revision, encode_payload(block)));
}

std::string pvt_geodetic(unsigned i) {
    SbfPvtGeodetic m;
    m.time = {first_ms + 1000 * i, 2304};
    m.mode = 4, m.error = 0, m.num_sv = 11;
    m.latitude = Angle::degrees(47 + 1e-6 * i).rad(), m.longitude = Angle::degrees(8).rad(), m.height = 500;
    m.vel_north = 1, m.vel_east = 2, m.vel_up = 3;
    return sbf_block(m);
}

std::string pvt_cartesian(unsigned i) {
    SbfPvtCartesian m;
    m.time = {first_ms + 1000 * i, 2304};
    m.mode = 1, m.error = 0, m.num_sv = 11;
    const Eigen::Vector3d place = to_ecef(Geodetic::degrees(47 + 1e-6 * i, 8, 500)).vector();
    m.x = place.x(), m.y = place.y(), m.z = place.z();
    return sbf_block(m);
}

std::string sentence(const std::string& body) {
    unsigned sum = 0;
    for (const char c : body)
        sum ^= static_cast<unsigned char>(c);
    return fmt::format("${}*{:02X}\r\n", body, sum);
}

std::string nmea_epoch(unsigned i) {
    const std::string place = fmt::format("4700.{:05d},N,00800.00000,E", 10 * i);
    return sentence(fmt::format("GNRMC,1200{:02d}.00,A,{},0.0,,050324,,,A", i, place)) +
           sentence(fmt::format("GNGGA,1200{:02d}.00,{},1,08,1.0,450.0,M,50.0,M,,", i, place));
}

std::string pos_row(unsigned i) {
    return fmt::format("2304 {:.3f} {:.9f} 8.0 500.0 1 9 0 0 0 0 0 0 0 0\n", first_ms * 1e-3 + i, 47 + 1e-6 * i);
}

std::string fixes_row(unsigned i) {
    return fmt::format("2024-03-05T12:00:{:02d}.000Z,3d,9,{:.9f},8.0,500.0\n", i, 47 + 1e-6 * i);
}

std::string gpx_point(unsigned i) {
    return fmt::format("<trkpt lat=\"{:.6f}\" lon=\"8\"><ele>450</ele><time>2024-03-05T12:00:{:02d}Z</time></trkpt>",
                       47 + 1e-6 * i, i);
}

struct ObservedFormat {
    std::string name;
    std::string content;
    std::size_t count = epochs;
};

std::vector<ObservedFormat> made_formats() {
    const std::string pos_head = "%  GPST      latitude(deg) longitude(deg)  height(m)   Q  ns\n";
    return {{"pvat.ubx", sixty(nav_pvat)},
            {"pvt.ubx", sixty(nav_pvt)},
            {"old.ubx", sixty(nav_sol_and_posllh)},
            {"geodetic.sbf", sixty(pvt_geodetic)},
            {"cartesian.sbf", sixty(pvt_cartesian)},
            {"log.nmea", sixty(nmea_epoch)},
            {"log.ulg", to_string(test::ulog_of(60, 0).bytes)},
            {"log.bin", to_string(test::dataflash_log(true, 1, 61).bytes)},  // one without a fix
            {"solution.pos", pos_head + sixty(pos_row)},
            {"bare.pos", sixty(pos_row)},
            {"fixes.csv", "time_utc,fix_type,satellites_used,lat_deg,lon_deg,height_m\n" + sixty(fixes_row)},
            {"track.gpx", "<gpx version=\"1.1\"><trk><trkseg>" + sixty(gpx_point) + "</trkseg></trk></gpx>"}};
}

// Epochs with a place, as compare counts them and as trajectory does.
std::array<std::size_t, 2> counts_of(const std::string& content, const std::string& name) {
    const auto geoid = test::flat_geoid(50);
    const auto series = parse_fix_series(content, name, &*geoid);
    EXPECT_TRUE(series) << (series ? "" : series.error().message);
    const ByteSpan bytes(reinterpret_cast<const std::uint8_t*>(content.data()), content.size());
    auto track = read_track(bytes, name, {&*geoid, std::nullopt});
    EXPECT_TRUE(track) << (track ? "" : track.error().message);
    if (!series || !track) return {};
    EXPECT_TRUE(clean_track(*track, Seconds(10)));
    return {series->fixes(), track->points.size()};
}

TEST(ObservedFormats, CompareAndTrajectorySeeTheSameEpochs) {
    for (const ObservedFormat& format : made_formats()) {
        const auto [compared, travelled] = counts_of(format.content, format.name);
        EXPECT_EQ(compared, format.count) << format.name;
        EXPECT_EQ(travelled, format.count) << format.name;
        std::printf("%-14s compare %zu trajectory %zu\n", format.name.c_str(), compared, travelled);
    }
}

// Places that compare and trajectory give to the same file are the same, to the rounding of the way through ECEF.
TEST(ObservedFormats, PlacesAreTheSame) {
    const auto geoid = test::flat_geoid(50);
    for (const ObservedFormat& format : made_formats()) {
        const auto series = parse_fix_series(format.content, format.name, &*geoid);
        const ByteSpan bytes(reinterpret_cast<const std::uint8_t*>(format.content.data()), format.content.size());
        const auto track = read_track(bytes, format.name, {&*geoid, std::nullopt});
        ASSERT_TRUE(series && track) << format.name;
        const auto first = std::find_if(series->samples.begin(), series->samples.end(),
                                        [](const FixSample& sample) { return sample.has_fix; });
        EXPECT_LT((to_ecef(first->position).vector() - track->points.front().position.vector()).norm(), 1e-6)
            << format.name;
        EXPECT_EQ(first->time, track->origin.value_or(GpsTime{}) + track->points.front().time) << format.name;
    }
}

struct RealOutput {
    const char* path;
    std::size_t repeated = 0;  // epochs that repeat a time, which a track leaves out
};

// Records of real receivers.
TEST(ObservedFormats, OfRealReceiversToo) {
    for (const RealOutput& real :
         {RealOutput{"receivers/galway_20181015_m8p_static/base-20181015-1654.ubx.gz"},
          RealOutput{"receivers/bend_f9t/F9T-L2-5min.ubx.gz"}, RealOutput{"tracks/NmeaSampleData.txt.gz"},
          RealOutput{"tracks/20221027-Crosscall-nmea.txt", 1}}) {
        SKYLOOP_REQUIRE_SHARED(path, real.path);
        const auto content = read_text_file(path);
        ASSERT_TRUE(content) << real.path;
        const auto [compared, travelled] = counts_of(*content, path.filename().string());
        EXPECT_EQ(compared, travelled + real.repeated) << real.path;
        EXPECT_GT(travelled, 250u) << real.path;
        std::printf("%-60s compare %zu trajectory %zu\n", real.path, compared, travelled);
    }
}

}  // namespace
}  // namespace skyloop
