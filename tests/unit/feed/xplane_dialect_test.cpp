#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "dialect_bytes.hpp"
#include "dialect_pose.hpp"
#include "feed_asides.hpp"
#include "run/feed/feed_dialect.hpp"

namespace skyloop {
namespace {

using testing::HasSubstr;
using Pose = NorthEastClimb;

Bytes rpos(double latitude = Pose::latitude) {
    HandBytes packet;
    packet.text("RPOS").u8('4').f64s({Pose::longitude, latitude, Pose::height});
    packet.f32s({33, Pose::pitch, Pose::yaw, Pose::roll, Pose::east, Pose::up, -Pose::north, 0.1, 0.2, 0.3});
    return packet.bytes();
}

Bytes rref(std::initializer_list<std::pair<int, double>> values) {
    HandBytes packet;
    packet.text("RREF,");
    for (const auto& [index, value] : values)
        packet.i32(index).f32(value);
    return packet.bytes();
}

const PoseTolerance rpos_tolerance{1e-9, 1e-6, 1e-6, 1e-4, 1e-6, true, true};

TEST(XplaneDialect, ReadsRposWithTheTimeOfRref) {
    const auto dialect = dialect_named("xplane");
    ASSERT_EQ(rpos().size(), 69u);
    const FeedNews timeless = dialect->hear(rpos(), 0);
    ASSERT_EQ(timeless.samples.size(), 1u) << timeless.refusal;
    expect_pose(timeless.samples[0], rpos_tolerance);
    EXPECT_FALSE(timeless.samples[0].source_time);
    dialect->hear(rref({{1, 100.5}, {2, 0}}), 1'000'000'000);
    EXPECT_EQ(dialect->hear(rpos(), 1'005'000'000).samples.at(0).source_time, Nanoseconds(100'505'000'000));
}

// A float of 200 000 s has steps of 15.6 ms.
TEST(XplaneDialect, ItsTimeGoesOnEvenlyAfterDays) {
    const auto dialect = dialect_named("xplane");
    constexpr std::int64_t step_ns = 33'333'333;
    Nanoseconds last{0};
    for (int i = 0; i < 300; ++i) {
        const std::int64_t now = i * step_ns;
        dialect->hear(rref({{1, 200'000 + static_cast<double>(now) * 1e-9}}), now);
        const auto time = dialect->hear(rpos(), now).samples.at(0).source_time;
        ASSERT_TRUE(time);
        EXPECT_NEAR(static_cast<double>(time->count()) * 1e-9, 200'000 + static_cast<double>(now) * 1e-9, 0.0079);
        if (i > 60) {
            EXPECT_NEAR(static_cast<double>((*time - last).count()), step_ns, 1e5) << i;
        }
        last = *time;
    }
    // Scenery that loads.
    dialect->hear(rref({{1, 200'020}}), 20'000'000'000);
    EXPECT_NEAR(static_cast<double>(dialect->hear(rpos(), 20'000'000'000).samples.at(0).source_time->count()) * 1e-9,
                200'020, 0.0079);
}

TEST(XplaneDialect, TellsPauses) {
    const auto dialect = dialect_named("xplane");
    EXPECT_FALSE(pause_told(dialect->hear(rref({{2, 0}}), 0)));
    EXPECT_EQ(pause_told(dialect->hear(rref({{2, 1}}), 0)), true);
    EXPECT_FALSE(pause_told(dialect->hear(rref({{2, 1}}), 0)));
    EXPECT_EQ(pause_told(dialect->hear(rref({{2, 0}}), 0)), false);
}

TEST(XplaneDialect, ItsTimeGoesOnAfterAPauseFromWhereItStood) {
    constexpr std::int64_t ms = 1'000'000;
    for (const bool flag_first : {false, true}) {
        const auto dialect = dialect_named("xplane");
        const auto time_ms = [&](std::int64_t at_ms) {
            return dialect->hear(rpos(), at_ms * ms).samples.at(0).source_time->count() / ms;
        };
        dialect->hear(rref({{1, 100}, {2, 0}}), 0);
        dialect->hear(rref({{1, 100}, {2, 1}}), 20 * ms);
        EXPECT_EQ(time_ms(3000), 100'000);
        // The flag falls a frame before the time moves.
        dialect->hear(flag_first ? rref({{2, 0}, {1, 100}}) : rref({{1, 100}, {2, 0}}), 3000 * ms);
        EXPECT_EQ(time_ms(3005), 100'005);
        dialect->hear(rref({{1, 100.25}, {2, 0}}), 3250 * ms);
        EXPECT_NEAR(static_cast<double>(time_ms(3250)), 100'250, 1);
    }
}

TEST(XplaneDialect, AsksInBothWaysUntilPosesCome) {
    FeedContext context;
    context.rate_hz = 40;
    const auto dialect = dialect_named("xplane", context);
    const auto words = dialect->say();
    ASSERT_EQ(words.size(), 4u);
    ASSERT_EQ(words[0].size(), 413u);
    EXPECT_EQ(Bytes(words[0].begin(), words[0].begin() + 13), (Bytes{'R', 'R', 'E', 'F', 0, 40, 0, 0, 0, 1, 0, 0, 0}));
    EXPECT_STREQ(reinterpret_cast<const char*>(words[0].data()) + 13, "sim/time/total_running_time_sec");
    EXPECT_STREQ(reinterpret_cast<const char*>(words[1].data()) + 13, "sim/time/paused");
    EXPECT_EQ(words[2], (Bytes{'R', 'P', 'O', 'S', 0, 40, 0, 0, 0}));
    EXPECT_EQ(words[3], (Bytes{'R', 'P', 'O', 'S', 0, '4', '0', 0}));
    dialect->hear(rpos(), 0);
    EXPECT_TRUE(dialect->say().empty());
    EXPECT_EQ(dialect->say().size(), 4u);  // no pose since
}

Bytes data_rows(double latitude) {
    HandBytes packet;
    packet.text("DATA@");
    packet.i32(17).f32s({Pose::pitch, Pose::roll, Pose::yaw, 0, 0, 0, 0, 0});
    packet.i32(21).f32s({1, 2, 3, Pose::east, Pose::up, -Pose::north, 0, 0});
    packet.i32(20).f32s({latitude, Pose::longitude, Pose::height / 0.3048, 0, 0, 0, 0, 0});
    return packet.bytes();
}

TEST(XplaneDialect, ReadsDataRowsOnTheirCoarseGrid) {
    const auto dialect = dialect_named("xplane");
    const FeedNews news = dialect->hear(data_rows(Pose::latitude), 0);
    ASSERT_EQ(news.samples.size(), 1u) << news.refusal;
    expect_pose(news.samples[0], {4e-6, 1e-3, 0.01, 1e-4, 0, true, false});
}

TEST(XplaneDialect, RowsAreLeftOutWhileExactPosesCome) {
    const auto dialect = dialect_named("xplane");
    dialect->hear(rpos(), 1'000'000'000);
    EXPECT_TRUE(dialect->hear(data_rows(Pose::latitude), 2'000'000'000).samples.empty());
    EXPECT_EQ(dialect->hear(data_rows(Pose::latitude), 4'000'000'000).samples.size(), 1u);
}

TEST(XplaneDialect, RefusesOtherPackets) {
    const auto dialect = dialect_named("xplane");
    const Bytes whole = rpos();
    EXPECT_THAT(dialect->hear(ByteSpan(whole).first(57), 0).refusal, HasSubstr("57 bytes; expected 69"));
    EXPECT_EQ(dialect->hear(rpos(std::nan("")), 0).refused, 1u);
    EXPECT_THAT(dialect->hear(to_bytes("DATA@123"), 0).refusal, HasSubstr("rows of 36"));
    EXPECT_THAT(dialect->hear(to_bytes("RREF,123"), 0).refusal, HasSubstr("RREF"));
    EXPECT_THAT(dialect->hear(to_bytes("hello"), 0).refusal, HasSubstr("none of RPOS"));
    EXPECT_EQ(dialect->hear({}, 0).refused, 1u);
    EXPECT_EQ(dialect->hear(to_bytes(std::string("BECN\0\1\2", 7)), 0).refused, 0u);
    // −999 is X-Plane's word for nothing.
    EXPECT_TRUE(dialect->hear(data_rows(-999), 0).samples.empty());
}

}  // namespace
}  // namespace skyloop
