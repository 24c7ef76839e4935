// Pages of a whole constellation, judged by a client that knows the interface document alone.
#include <gtest/gtest.h>

#include "support/osnma_client.hpp"
#include "support/osnma_listener.hpp"

namespace skyloop {
namespace {

constexpr std::uint64_t seed = 77;
// 14:55 of a Wednesday of GST week 1276; at 15:00 the public key begins to be told.
const GpsTime begin = to_gps_time(2300, 3 * 86400.0 + 14 * 3600 + 55 * 60);

using test::OsnmaListener;
using test::point_of;
using test::root_of;

TEST(Osnma, AClientWithThePublicKeyAuthenticatesAll) {
    OsnmaListener listener({seed, begin});
    test::OsnmaClient client;
    client.public_keys[1] = test::octets_of(point_of(listener.keys->tree_xml(), 1));
    listener.listen(client, begin, std::chrono::minutes(12));
    const test::OsnmaVerdict verdict = client.judge();
    EXPECT_GE(verdict.roots, 3);
    EXPECT_EQ(verdict.wrong_roots, 0);
    EXPECT_EQ(verdict.signers, std::set<std::uint64_t>{1});
    EXPECT_EQ(verdict.key_statuses, std::set<std::uint64_t>{1}) << "nominal";
    EXPECT_EQ(verdict.keys, 24 * 5);
    EXPECT_EQ(verdict.wrong_keys, 0);
    for (const std::uint64_t adkd : {0u, 4u, 12u})
        EXPECT_EQ(verdict.wrong_tags.count(adkd), 0u) << adkd;
    auto tags = verdict.tags;
    EXPECT_GT(tags[0], 150);
    EXPECT_GT(tags[4], 45);
    EXPECT_GT(tags[12], 60);
    EXPECT_EQ(verdict.sequences, 23 * 5);
    EXPECT_EQ(verdict.wrong_sequences, 0);
}

// Who knows the root of the tree alone learns the key in the first minutes of an hour.
TEST(Osnma, TheMerkleTreeLeadsToThePublicKey) {
    OsnmaListener listener({seed, begin});
    test::OsnmaClient client;
    client.merkle_root = test::octets_of(root_of(listener.keys->tree_xml()));
    listener.listen(client, begin + std::chrono::minutes(5), std::chrono::minutes(15));
    const test::OsnmaVerdict verdict = client.judge();
    EXPECT_GE(verdict.public_keys, 2);
    EXPECT_EQ(verdict.wrong_public_keys, 0);
    EXPECT_EQ(verdict.told_keys, std::set<std::uint64_t>{1});
    EXPECT_GE(verdict.roots, 1);
    EXPECT_EQ(verdict.wrong_roots, 0);
}

TEST(Osnma, ANewPublicKeyIsAnnouncedAndThenSigns) {
    const GpsTime change = begin + std::chrono::minutes(25);
    OsnmaListener listener({seed, begin, OsnmaChange::new_key, change});
    test::OsnmaClient client;
    client.merkle_root = test::octets_of(root_of(listener.keys->tree_xml()));
    client.public_keys[1] = test::octets_of(point_of(listener.keys->tree_xml(), 1));
    listener.listen(client, begin, std::chrono::minutes(50));
    const test::OsnmaVerdict verdict = client.judge();
    EXPECT_EQ(verdict.told_keys, (std::set<std::uint64_t>{1, 2})) << "the first in the first minutes of the hour";
    EXPECT_EQ(verdict.signers, (std::set<std::uint64_t>{1, 2}));
    EXPECT_EQ(verdict.key_statuses, (std::set<std::uint64_t>{1, 4}));
    EXPECT_EQ(verdict.wrong_roots, 0);
    EXPECT_EQ(verdict.wrong_public_keys, 0);
    EXPECT_EQ(verdict.wrong_keys, 0);
    EXPECT_TRUE(verdict.wrong_tags.empty());
    EXPECT_EQ(listener.keys->public_keys(), 2);
    EXPECT_EQ(client.public_keys[2], test::octets_of(point_of(listener.keys->tree_xml(), 2)));
}

// Of a client that knows the root of the tree and the first public key, over what comes before and after.
test::OsnmaVerdict heard_through(OsnmaChange change, GpsTime at, std::chrono::minutes length) {
    OsnmaListener listener({seed, begin, change, at});
    test::OsnmaClient client;
    client.merkle_root = test::octets_of(root_of(listener.keys->tree_xml()));
    client.public_keys[1] = test::octets_of(point_of(listener.keys->tree_xml(), 1));
    listener.listen(client, at - std::chrono::minutes(8), length);
    return client.judge();
}

void expect_all_right(const test::OsnmaVerdict& verdict) {
    EXPECT_EQ(verdict.wrong_roots, 0);
    EXPECT_EQ(verdict.wrong_public_keys, 0);
    EXPECT_EQ(verdict.wrong_keys, 0);
    EXPECT_TRUE(verdict.wrong_tags.empty());
    EXPECT_EQ(verdict.wrong_sequences, 0);
}

constexpr std::uint64_t operational = 2, do_not_use = 3;
using Numbers = std::set<std::uint64_t>;

// Its root is told beforehand, so that no subframe is without a key that leads to a signed root.
TEST(Osnma, AChainEndsAndItsSuccessorGoesOn) {
    const test::OsnmaVerdict verdict =
        heard_through(OsnmaChange::new_chain, begin + std::chrono::minutes(20), std::chrono::minutes(12));
    expect_all_right(verdict);
    EXPECT_EQ(verdict.chains, (Numbers{1, 2}));
    EXPECT_EQ(verdict.key_statuses, (Numbers{1, 2})) << "end of chain, then nominal";
    EXPECT_EQ(verdict.statuses, Numbers{operational});
    auto keys = verdict.keys_by_chain;
    EXPECT_EQ(keys[2], 5 * 8);
    EXPECT_EQ(keys[1], 0) << "whose root was told before the client listened";
}

TEST(Osnma, ARevokedChainIsNotToBeUsedAndAnotherFollows) {
    const test::OsnmaVerdict verdict =
        heard_through(OsnmaChange::revoked_chain, begin + std::chrono::minutes(14), std::chrono::minutes(40));
    expect_all_right(verdict);
    EXPECT_EQ(verdict.chains, (Numbers{1, 2}));
    EXPECT_EQ(verdict.key_statuses, (Numbers{1, 3}));
    EXPECT_EQ(verdict.statuses, (Numbers{operational, do_not_use}));
    auto keys = verdict.keys_by_chain;
    EXPECT_EQ(keys[1], 5 * 2 * (8 + 15));
    EXPECT_EQ(keys[2], 5 * 2 * 17);
}

TEST(Osnma, ARevokedPublicKeySignsNoMore) {
    const test::OsnmaVerdict verdict =
        heard_through(OsnmaChange::revoked_key, begin + std::chrono::minutes(14), std::chrono::minutes(26));
    expect_all_right(verdict);
    EXPECT_EQ(verdict.chains, (Numbers{1, 2}));
    EXPECT_EQ(verdict.key_statuses, (Numbers{1, 5}));
    EXPECT_EQ(verdict.statuses, (Numbers{operational, do_not_use}));
    EXPECT_EQ(verdict.signers, (Numbers{1, 2}));
    EXPECT_TRUE(verdict.told_keys.contains(2));
}

TEST(Osnma, AnAlertMessageIsAllThatIsSent) {
    const test::OsnmaVerdict verdict =
        heard_through(OsnmaChange::alert, begin + std::chrono::minutes(25), std::chrono::minutes(14));
    expect_all_right(verdict);
    EXPECT_GE(verdict.alerts, 1);
    EXPECT_EQ(verdict.key_statuses, (Numbers{1, 7}));
    EXPECT_EQ(verdict.statuses, (Numbers{operational, do_not_use}));
    EXPECT_EQ(verdict.told_keys, Numbers{}) << "no public key";
}

// The same of a client that was given the keys of another run: nothing is authenticated.
TEST(Osnma, AnotherSeedIsAnotherRoot) {
    OsnmaListener listener({seed, begin}), other({seed + 1, begin});
    test::OsnmaClient client;
    client.public_keys[1] = test::octets_of(point_of(other.keys->tree_xml(), 1));
    client.merkle_root = test::octets_of(root_of(other.keys->tree_xml()));
    listener.listen(client, begin, std::chrono::minutes(12));
    const test::OsnmaVerdict verdict = client.judge();
    EXPECT_EQ(verdict.roots, 0);
    EXPECT_GT(verdict.wrong_roots, 0);
    EXPECT_EQ(verdict.public_keys, 0);
    EXPECT_GT(verdict.wrong_public_keys, 0);
}

TEST(Osnma, TheChainBeginsAnHourBeforeTheRunAndEnds) {
    const TeslaChain chain(seed, begin);
    EXPECT_EQ(chain.key(begin - osnma_subframe), chain.root());
    EXPECT_FALSE(chain.key(begin - 2 * osnma_subframe));
    EXPECT_TRUE(chain.key(begin + (TeslaChain::key_count - 1) * osnma_subframe));
    EXPECT_FALSE(chain.key(begin + TeslaChain::key_count * osnma_subframe));
    const OsnmaKeys keys({seed, begin});
    EXPECT_EQ(keys.chain(1).first(), to_gps_time(2300, 3 * 86400.0 + 13 * 3600));
    test::FourSystems source;
    OsnmaSender sender(std::make_shared<const OsnmaKeys>(OsnmaSettings{seed, begin}));
    const GpsTime late = begin + (TeslaChain::key_count + 5) * osnma_subframe + std::chrono::seconds(1);
    EXPECT_EQ(sender.field({Constellation::galileo, 2}, source, LeapSeconds::announced(), late) & 0xFFFFFFFF, 0u);
}

}  // namespace
}  // namespace skyloop
