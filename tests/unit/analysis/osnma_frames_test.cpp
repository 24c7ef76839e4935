// The tests' client of OSNMA on what Galileo's own satellites sent: so its rules are the right ones.
#include <gtest/gtest.h>

#include <map>

#include "../../support/oracle_table.hpp"
#include "../../support/osnma_client.hpp"
#include "../../support/page_bits.hpp"
#include "../../support/real_frames.hpp"

namespace skyloop {
namespace {

// Besançon, 2025-04-25, GST week 1339: public key 1 of the European GNSS Service Centre, in force from 2024-01-15 on.
TEST(OsnmaFrames, TheClientAuthenticatesRealSatellites) {
    SKYLOOP_REQUIRE_SHARED(log, "receivers/besancon_20250425_ublox/16dBatt_no_interference_coldstart.ubx.gz");
    test::OsnmaClient client;
    client.public_keys[1] = test::octets_of("0397EB43789AA0F6D052A638468ECF5278E6F6DF8465ECB8D8B84B8C7A3501F73B");
    std::map<int, std::int64_t> last;  // start of the last pair of pages of a satellite
    for (const test::RealFrame& frame : test::real_frames(log)) {
        if (frame.gnss != 2 || frame.words.size() != 8) continue;
        const test::PageBits word = test::inav_word_of(frame.words);
        const std::uint64_t type = word.field(0, 6);
        // Words that tell their time; others follow each two seconds, where none is lost.
        if (type == 5)
            last[frame.sv] = static_cast<std::int64_t>(word.field(85, 20));
        else if (type == 6)
            last[frame.sv] = static_cast<std::int64_t>(word.field(105, 20));
        else if (type == 0 && word.field(6, 2) == 2)
            last[frame.sv] = static_cast<std::int64_t>(word.field(108, 20));
        else if (last.contains(frame.sv))
            last[frame.sv] += 2;
        else
            continue;
        client.take(frame.sv, 1339, last[frame.sv], frame.words);
    }
    const test::OsnmaVerdict verdict = client.judge();
    EXPECT_GE(verdict.roots, 3);
    EXPECT_EQ(verdict.wrong_roots, 0);
    EXPECT_EQ(verdict.key_statuses, std::set<std::uint64_t>{1});
    EXPECT_GT(verdict.keys, 100);
    EXPECT_LE(verdict.wrong_keys, 2);
    auto tags = verdict.tags, wrong = verdict.wrong_tags;
    for (const std::uint64_t adkd : {0u, 4u, 12u}) {
        EXPECT_GT(tags[adkd], 30) << adkd;
        EXPECT_LE(wrong[adkd] * 50, tags[adkd]) << adkd << ": pages that were received with gaps";
    }
    EXPECT_GT(verdict.sequences, 100);
    EXPECT_LE(verdict.wrong_sequences, 2);
}

}  // namespace
}  // namespace skyloop
