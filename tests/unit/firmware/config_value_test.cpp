#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <array>

#include "config_support.hpp"
#include "firmware/ublox/config/config_handler.hpp"

namespace skyloop::firmware {
namespace {

using testing::ElementsAre;
using testing::IsEmpty;
using testing::Pair;

constexpr std::uint32_t unknown_item = 0x30210099;
constexpr std::uint32_t every_item = 0x0FFFFFFF, rate_group = 0x3021FFFF;

struct Configured {
    explicit Configured(BoardProfile profile = whole_board())
        : board(std::move(profile)), store(factory_config(board)), values(board, store) {}

    Verdict set(std::uint8_t layers, const KeyValues& pairs, std::uint8_t version = 0, std::uint8_t transaction = 0) {
        return values.valset(valset_payload(layers, pairs, version, transaction)).verdict;
    }
    Verdict erase(std::uint8_t layers, std::vector<std::uint32_t> keys, std::uint8_t version = 0,
                  std::uint8_t transaction = 0) {
        return values.valdel(valdel_payload(layers, std::move(keys), version, transaction)).verdict;
    }
    /// The pairs of the answer; nothing when the question was refused.
    std::optional<KeyValues> get(std::uint8_t layer, std::vector<std::uint32_t> keys, std::uint16_t position = 0) {
        const ConfigOutcome outcome = values.valget(valget_payload(layer, std::move(keys), position));
        EXPECT_EQ(outcome.answers.size(), outcome.verdict == Verdict::acknowledge ? 1U : 0U);
        if (outcome.answers.empty()) return std::nullopt;
        const auto frame = parse_frame(outcome.answers[0]);
        if (!frame || frame->id != CfgValget::message_id) return std::nullopt;
        const auto answer = decode_payload<CfgValget>(frame->payload);
        if (!answer || answer->version != 1 || answer->layer != layer || answer->position != position)
            return std::nullopt;
        KeyValues pairs;
        for (const ConfigPair& pair : answer->pairs)
            pairs.emplace_back(pair.key, pair.value);
        return pairs;
    }

    BoardProfile board;
    ConfigStore store;
    ValueConfig values;
};

TEST(Valset, SetsTheLayersThatItNames) {
    Configured c;
    EXPECT_EQ(c.set(1, {{period_item, 200}}), Verdict::acknowledge);
    EXPECT_EQ(c.store.value(period_item), 200U);
    EXPECT_TRUE(c.store.values(ConfigLayer::battery).empty());
    EXPECT_EQ(c.set(6, {{period_item, 100}}), Verdict::acknowledge);
    EXPECT_EQ(c.store.value(period_item), 200U);
    EXPECT_EQ(c.store.stored(ConfigLayer::battery, period_item), 100U);
    EXPECT_EQ(c.store.stored(ConfigLayer::flash, period_item), 100U);
}

// The frames of RECEIVER.md 1.1.
TEST(Valset, TakesTheFramesThatClientsSend) {
    Configured c;
    const Bytes baud{0x00, 0x01, 0x00, 0x00, 0x01, 0x00, 0x52, 0x40, 0x00, 0xC2, 0x01, 0x00};
    EXPECT_EQ(c.values.valset(baud).verdict, Verdict::acknowledge);
    EXPECT_EQ(c.store.value(key::uart1_baudrate), 115200U);
    const Bytes poll{0x00, 0x00, 0x00, 0x00, 0x01, 0x00, 0x73, 0x10};
    const ConfigOutcome answer = c.values.valget(poll);
    EXPECT_EQ(answer.verdict, Verdict::acknowledge);
    EXPECT_THAT(answer.answers, ElementsAre(Bytes{0xB5, 0x62, 0x06, 0x8B, 0x09, 0x00, 0x01, 0x00, 0x00, 0x00, 0x01,
                                                  0x00, 0x73, 0x10, 0x01, 0x20, 0xBD}));
}

TEST(Valset, IsAllOrNothing) {
    Configured c;
    EXPECT_EQ(c.set(7, {{period_item, 200}, {cycles_item, 2}, {unknown_item, 1}, {reference_item, 0}, {pvt_item, 1}}),
              Verdict::refuse);
    EXPECT_EQ(c.set(7, {{period_item, 200}, {key::navspg_dynmodel, 1}}), Verdict::refuse);  // out of the enumeration
    EXPECT_EQ(c.set(7, {{period_item, 10}}), Verdict::refuse);                              // faster than the board can
    EXPECT_EQ(c.set(7, {{period_item, 200}, {key::uart1_baudrate, 57600}}), Verdict::refuse);
    EXPECT_EQ(c.store.values(ConfigLayer::ram), c.store.values(ConfigLayer::factory));
    EXPECT_TRUE(c.store.values(ConfigLayer::battery).empty());
    EXPECT_TRUE(c.store.values(ConfigLayer::flash).empty());
}

TEST(Valset, RefusesWhatIsNotOnTheWireOrNotOfTheBoard) {
    BoardProfile board = whole_board();
    board.absent_keys = {key::tmode_mode};
    Configured c(board);
    EXPECT_EQ(c.set(1, {{key::tmode_mode, 0}}), Verdict::refuse);
    EXPECT_EQ(c.set(1, {{*rate_key({0x01, 0x06}, PortId::uart1), 1}}), Verdict::refuse);
    EXPECT_EQ(c.set(1, {{0x20210001, 200}}), Verdict::refuse);  // right item, wrong size
}

TEST(Valset, RefusesBadHeads) {
    Configured c;
    EXPECT_EQ(c.set(1, {{period_item, 200}}, 2), Verdict::refuse);
    EXPECT_EQ(c.set(0, {{period_item, 200}}), Verdict::refuse);
    EXPECT_EQ(c.set(8 | 1, {{period_item, 200}}), Verdict::refuse);
    EXPECT_EQ(c.set(1, {{period_item, 200}}, 1, 4), Verdict::refuse);
    EXPECT_EQ(c.values.valset({}).verdict, Verdict::refuse);
    EXPECT_EQ(c.values.valset(Bytes{0, 1, 0}).verdict, Verdict::refuse);
    EXPECT_EQ(c.store.value(period_item), 1000U);
    EXPECT_EQ(c.set(1, {{period_item, 200}}, 0, 9), Verdict::acknowledge);  // reserved in version 0
}

TEST(Valset, RefusesTruncatedValuesAndKeysWithoutASize) {
    Configured c;
    Bytes payload = valset_payload(1, {{period_item, 200}, {cycles_item, 1}});
    payload.pop_back();
    EXPECT_EQ(c.values.valset(payload).verdict, Verdict::refuse);
    for (const std::uint8_t size : std::array<std::uint8_t, 3>{0x00, 0x60, 0x70}) {
        payload = valset_payload(1, {{period_item, 200}});
        const Bytes more{0x01, 0x00, 0x21, size, 0x01, 0x00};
        payload.insert(payload.end(), more.begin(), more.end());
        EXPECT_EQ(c.values.valset(payload).verdict, Verdict::refuse);
    }
    EXPECT_EQ(c.store.value(period_item), 1000U);
}

TEST(Valset, TakesSixtyFourPairsAndNotMore) {
    Configured c;
    KeyValues pairs(63, {cycles_item, 2});
    pairs.emplace_back(period_item, 200);
    EXPECT_EQ(c.set(1, pairs), Verdict::acknowledge);
    pairs.emplace_back(period_item, 100);
    EXPECT_EQ(c.set(1, pairs), Verdict::refuse);
    EXPECT_EQ(c.store.value(period_item), 200U);
}

TEST(Valset, OfDuplicateKeysTheLastWins) {
    Configured c;
    EXPECT_EQ(c.set(1, {{cycles_item, 1}, {period_item, 200}, {cycles_item, 3}}), Verdict::acknowledge);
    EXPECT_EQ(c.store.value(cycles_item), 3U);
}

TEST(Valset, WithoutPairsDoesNothing) {
    Configured c;
    EXPECT_EQ(c.set(7, {}), Verdict::acknowledge);
    EXPECT_EQ(c.store.values(ConfigLayer::ram), c.store.values(ConfigLayer::factory));
}

TEST(Valset, CutsLogicalsToTheirBit) {
    Configured c;
    EXPECT_EQ(c.set(1, {{key::itfm_enable, 0xFF}}), Verdict::acknowledge);
    EXPECT_EQ(c.store.value(key::itfm_enable), 1U);
    EXPECT_EQ(c.set(1, {{0x1031001F, 2}, {0x10310021, 2}, {0x10310025, 2}, {0x10310022, 2}, {0x10310024, 2}}),
              Verdict::refuse);  // 2 is off: no system is left
}

// ArduPilot keeps settings of an M10 in RAM and battery alone for that reason.
TEST(Valset, HasNoFlashWithFirmwareInRom) {
    BoardProfile board = whole_board();
    board.identity.generation = 10;
    board.identity.software = "ROM SPG 5.10";
    Configured c(board);
    for (std::uint8_t layers = 4; layers < 8; ++layers)
        EXPECT_EQ(c.set(layers, {{period_item, 200}}), Verdict::refuse) << int{layers};
    EXPECT_EQ(c.erase(4, {period_item}), Verdict::refuse);
    EXPECT_EQ(c.get(2, {period_item}), std::nullopt);
    EXPECT_EQ(c.set(3, {{period_item, 200}}), Verdict::acknowledge);
}

TEST(Valset, KeepsRamConsistent) {
    Configured c;
    const KeyValues nothing{{0x1031001F, 0}, {0x10310021, 0}};
    EXPECT_EQ(c.set(1, nothing), Verdict::refuse);
    EXPECT_EQ(c.set(3, nothing), Verdict::refuse);
    EXPECT_TRUE(c.store.values(ConfigLayer::battery).empty());
    EXPECT_EQ(c.set(2, nothing), Verdict::refuse) << "the next start would have no system";
    EXPECT_EQ(c.set(4, nothing), Verdict::refuse);
    EXPECT_EQ(c.set(1, {{key::ant_power_down, 1}}), Verdict::refuse);
    EXPECT_EQ(c.set(1, {{key::ant_power_down, 1}, {key::ant_voltage_control, 1}}), Verdict::acknowledge);
}

TEST(Valset, RefusesToLeaveNoMajorSystemWhateverElseStaysOn) {
    constexpr std::uint32_t qzss_item = 0x10310024, sbas_item = 0x10310020, gps_l1_item = 0x10310001;
    const KeyValues no_major{{gps_item, 0}, {galileo_item, 0}, {beidou_item, 0}, {glonass_item, 0}};
    Configured c;
    EXPECT_EQ(c.set(1, {{qzss_item, 1}, {sbas_item, 1}}), Verdict::acknowledge);
    EXPECT_EQ(c.set(1, no_major), Verdict::refuse) << "neither QZSS nor SBAS gives a position";
    EXPECT_EQ(c.set(1, {{gps_l1_item, 0}, {galileo_item, 0}}), Verdict::refuse) << "GPS without a signal";
    EXPECT_EQ(c.set(1, {{gps_item, 0}}, 1, 1), Verdict::acknowledge);
    EXPECT_EQ(c.set(1, {{galileo_item, 0}}, 1, 3), Verdict::refuse);
    EXPECT_EQ(c.store.value(gps_item), 1U);
    EXPECT_EQ(c.set(1, {{gps_item, 0}, {galileo_item, 0}, {beidou_item, 1}}), Verdict::acknowledge);
}

TEST(Valset, TakesTimeForFlashAndForNewSignals) {
    Configured c;
    c.board.timing.flash_write = Seconds(0.2);
    EXPECT_EQ(c.values.valset(valset_payload(3, {{period_item, 200}})).work, Seconds(0));
    EXPECT_EQ(c.values.valset(valset_payload(4, {{period_item, 200}})).work, Seconds(0.2));
    EXPECT_GT(c.values.valset(valset_payload(1, {{glonass_item, 1}})).work, Seconds(0));
    EXPECT_EQ(c.values.valset(valset_payload(1, {{glonass_item, 1}})).work, Seconds(0));  // nothing new
    EXPECT_EQ(c.values.valdel(valdel_payload(4, {period_item})).work, Seconds(0.2));
    EXPECT_EQ(c.values.valdel(valdel_payload(2, {period_item})).work, Seconds(0));
}

TEST(Valset, ObeysTheLock) {
    constexpr std::uint32_t lock = 0x10F60009, unlocked = 0x30F6000A;
    Configured c;
    EXPECT_EQ(c.set(1, {{unlocked, 0x21}, {lock, 1}}), Verdict::acknowledge);
    EXPECT_EQ(c.set(1, {{pvt_item, 1}}), Verdict::refuse);
    EXPECT_EQ(c.set(1, {{lock, 0}}), Verdict::refuse);
    EXPECT_EQ(c.erase(2, {pvt_item}), Verdict::refuse);
    EXPECT_EQ(c.set(1, {{pvt_item, 1}}, 1, 1), Verdict::refuse);
    EXPECT_EQ(c.set(1, {{period_item, 150}}, 1, 1), Verdict::acknowledge);
    EXPECT_EQ(c.set(1, {{pvt_item, 1}}, 1, 2), Verdict::refuse) << "at once, not at the end of the transaction";
    EXPECT_EQ(c.set(1, {}, 1, 3), Verdict::refuse) << "which is over";
    EXPECT_EQ(c.set(1, {{period_item, 200}}), Verdict::acknowledge);  // of the group that is left open
    EXPECT_EQ(c.store.value(pvt_item), 0U);
    EXPECT_EQ(c.store.value(period_item), 200U);
    EXPECT_TRUE(c.get(0, {pvt_item}));
}

TEST(Valset, TransactionsTakeEffectAtTheirEnd) {
    Configured c;
    EXPECT_EQ(c.set(1, {{period_item, 200}}, 1, 1), Verdict::acknowledge);
    EXPECT_EQ(c.set(1, {{cycles_item, 2}}, 1, 2), Verdict::acknowledge);
    EXPECT_EQ(c.store.values(ConfigLayer::ram), c.store.values(ConfigLayer::factory));
    EXPECT_EQ(c.set(1, {{period_item, 100}}, 1, 3), Verdict::acknowledge);
    EXPECT_EQ(c.store.value(period_item), 100U);
    EXPECT_EQ(c.store.value(cycles_item), 2U);
    EXPECT_EQ(c.set(1, {}, 1, 3), Verdict::refuse);  // it is over
}

TEST(Valset, BeginningAnewForgetsWhatWasPending) {
    Configured c;
    EXPECT_EQ(c.set(1, {{period_item, 200}}, 1, 1), Verdict::acknowledge);
    EXPECT_EQ(c.set(1, {{cycles_item, 2}}, 1, 1), Verdict::acknowledge);
    EXPECT_EQ(c.set(1, {}, 1, 3), Verdict::acknowledge);
    EXPECT_EQ(c.store.value(period_item), 1000U);
    EXPECT_EQ(c.store.value(cycles_item), 2U);
}

TEST(Valset, TransactionsAreCancelled) {
    const auto still_open = [](Configured& c) { return c.set(1, {}, 1, 3) == Verdict::acknowledge; };
    const auto begun = [](Configured& c) { return c.set(1, {{period_item, 200}}, 1, 1) == Verdict::acknowledge; };
    Configured c;
    EXPECT_FALSE(still_open(c));  // apply without begin
    EXPECT_EQ(c.set(1, {{period_item, 200}}, 1, 2), Verdict::refuse);
    ASSERT_TRUE(begun(c));
    EXPECT_EQ(c.set(3, {{cycles_item, 2}}, 1, 2), Verdict::refuse);  // other layers
    EXPECT_FALSE(still_open(c));
    ASSERT_TRUE(begun(c));
    EXPECT_EQ(c.set(1, {{unknown_item, 2}}, 1, 2), Verdict::refuse);
    EXPECT_FALSE(still_open(c));
    ASSERT_TRUE(begun(c));
    EXPECT_EQ(c.erase(2, {period_item}, 1, 2), Verdict::refuse);  // of another kind
    EXPECT_FALSE(still_open(c));
    ASSERT_TRUE(begun(c));
    EXPECT_TRUE(c.get(0, {period_item}));
    EXPECT_FALSE(still_open(c));
    ASSERT_TRUE(begun(c));
    EXPECT_EQ(c.set(1, {{cycles_item, 1}}), Verdict::acknowledge);
    EXPECT_FALSE(still_open(c));
    ASSERT_TRUE(begun(c));
    c.values.cancel();
    EXPECT_FALSE(still_open(c));
    EXPECT_EQ(c.store.value(period_item), 1000U);
}

TEST(Valset, AnInconsistentTransactionIsRefusedAtItsEnd) {
    Configured c;
    EXPECT_EQ(c.set(1, {{0x1031001F, 0}}, 1, 1), Verdict::acknowledge);
    EXPECT_EQ(c.set(1, {{0x10310021, 0}}, 1, 3), Verdict::refuse);
    EXPECT_EQ(c.store.value(0x1031001F), 1U);
    EXPECT_EQ(c.set(1, {}, 1, 3), Verdict::refuse);
}

TEST(Valget, AnswersInTheOrderOfTheQuestion) {
    Configured c;
    c.store.set(in_ram, pvt_item, 4);
    EXPECT_THAT(*c.get(0, {pvt_item, period_item, cycles_item}),
                ElementsAre(Pair(pvt_item, 4), Pair(period_item, 1000), Pair(cycles_item, 1)));
    EXPECT_THAT(*c.get(7, {pvt_item}), ElementsAre(Pair(pvt_item, 0)));
}

TEST(Valget, GivesOfTheSavedLayersWhatTheyHold) {
    Configured c;
    EXPECT_FALSE(c.get(1, {period_item}));
    c.store.set(in_battery, period_item, 200);
    EXPECT_THAT(*c.get(1, {cycles_item, period_item}), ElementsAre(Pair(period_item, 200)));
    EXPECT_FALSE(c.get(2, {cycles_item, period_item}));
    EXPECT_FALSE(c.get(1, {cycles_item}));
    EXPECT_THAT(*c.get(1, {every_item}), ElementsAre(Pair(period_item, 200)));
}

TEST(Valget, RefusesWhatItDoesNotKnow) {
    Configured c;
    EXPECT_FALSE(c.get(0, {period_item, unknown_item}));
    EXPECT_FALSE(c.get(0, {0x3099FFFF}));  // no such group
    EXPECT_FALSE(c.get(0, {0x20FEFFFF}));  // items that are not on the wire
    EXPECT_FALSE(c.get(0, {*rate_key({0x01, 0x06}, PortId::uart1)}));
    EXPECT_FALSE(c.get(3, {period_item}));
    EXPECT_FALSE(c.get(0, {}));
    EXPECT_FALSE(c.get(0, std::vector<std::uint32_t>(65, period_item)));
    EXPECT_EQ(c.get(0, std::vector<std::uint32_t>(64, period_item))->size(), 64U);
    Bytes payload = valget_payload(0, {period_item});
    payload[0] = 1;
    EXPECT_EQ(c.values.valget(payload).verdict, Verdict::refuse);
    payload = valget_payload(0, {period_item});
    payload.pop_back();
    EXPECT_EQ(c.values.valget(payload).verdict, Verdict::refuse);
}

TEST(Valget, AWildcardMeansItsGroupInAscendingOrder) {
    Configured c;
    for (const std::uint32_t wildcard : {rate_group, 0x1021FFFFu, 0x0021FFFFu})
        EXPECT_THAT(*c.get(0, {wildcard}),
                    ElementsAre(Pair(period_item, 1000), Pair(cycles_item, 1), Pair(reference_item, 1)));
    EXPECT_THAT(*c.get(0, {pvt_item, rate_group}),
                ElementsAre(Pair(pvt_item, 0), Pair(period_item, 1000), Pair(cycles_item, 1), Pair(reference_item, 1)));
}

// satpulse's configurator asks for both groups at once; a ZED-F9P with HPG 1.51 has nothing in the second.
TEST(Valget, AGroupWithoutItemsIsNotUnknown) {
    Configured c;
    constexpr std::uint32_t empty_group = 0x1099FFFF;
    EXPECT_EQ(c.get(0, {rate_group, empty_group})->size(), 3U);
    EXPECT_EQ(c.get(0, {empty_group, rate_group})->size(), 3U);
    EXPECT_FALSE(c.get(0, {rate_group, unknown_item}));
    EXPECT_FALSE(c.get(0, {empty_group}));
}

// A ZED-F9P refuses a page past the end, an X20P answers an empty one.
TEST(Valget, APagePastTheEndIsRefusedOrEmpty) {
    Configured c;
    EXPECT_THAT(*c.get(0, {rate_group}, 2), ElementsAre(Pair(reference_item, 1)));
    EXPECT_FALSE(c.get(0, {rate_group}, 3));
    c.board.quirks.empty_valget_page = true;
    EXPECT_THAT(*c.get(0, {rate_group}, 3), IsEmpty());
    EXPECT_THAT(*c.get(0, {rate_group}, 64), IsEmpty());
    EXPECT_FALSE(c.get(2, {rate_group})) << "a layer without these items";
}

TEST(Valget, GivesEverythingPageByPage) {
    for (const std::uint32_t wildcard : {every_item, 0x0FFF0000u}) {
        Configured c;
        std::size_t on_the_wire = 0;
        for (const ConfigKey& key : config_keys())
            on_the_wire += is_of_ublox(key.id) ? 1U : 0U;
        KeyValues all;
        for (std::size_t size = 64; size == 64;) {
            const auto page = c.get(0, {wildcard}, static_cast<std::uint16_t>(all.size()));
            ASSERT_TRUE(page);
            size = page->size();
            all.insert(all.end(), page->begin(), page->end());
        }
        EXPECT_EQ(all.size(), on_the_wire);
        EXPECT_TRUE(std::is_sorted(all.begin(), all.end(), [](const auto& a, const auto& b) {
            return group_and_item(a.first) < group_and_item(b.first);
        }));
        for (const auto& [key, value] : all)
            EXPECT_EQ(c.store.value(key), value);
    }
}

TEST(Valget, SomeUnitsAnswerOneKeyAtATime) {
    Configured c;
    c.board.quirks.single_key_valget = true;
    EXPECT_FALSE(c.get(0, {period_item, cycles_item}));
    EXPECT_TRUE(c.get(0, {period_item}));
    EXPECT_TRUE(c.get(0, {rate_group}));
}

TEST(Valdel, ForgetsInTheSavedLayersAlone) {
    Configured c;
    c.store.set(in_ram | in_battery | in_flash, period_item, 200);
    EXPECT_EQ(c.erase(1, {period_item}), Verdict::refuse);
    EXPECT_EQ(c.erase(3, {period_item}), Verdict::refuse);
    EXPECT_EQ(c.erase(0, {period_item}), Verdict::refuse);
    EXPECT_EQ(c.erase(2, {period_item, cycles_item}), Verdict::acknowledge);  // the number of cycles is not set there
    EXPECT_EQ(c.store.stored(ConfigLayer::battery, period_item), std::nullopt);
    EXPECT_EQ(c.store.stored(ConfigLayer::flash, period_item), 200U);
    EXPECT_EQ(c.store.value(period_item), 200U);
}

TEST(Valdel, IsAllOrNothingAndKnowsWildcards) {
    Configured c;
    for (const std::uint32_t key : {period_item, cycles_item, pvt_item})
        c.store.set(in_flash, key, 200);
    EXPECT_EQ(c.erase(4, {period_item, unknown_item}), Verdict::refuse);
    EXPECT_EQ(c.erase(4, {period_item, 0x3099FFFF}), Verdict::refuse);
    EXPECT_EQ(c.store.values(ConfigLayer::flash).size(), 3U);
    EXPECT_EQ(c.erase(4, {rate_group}), Verdict::acknowledge);
    EXPECT_EQ(c.store.values(ConfigLayer::flash).size(), 1U);
    EXPECT_EQ(c.erase(4, {0x0FFF0000}), Verdict::acknowledge);
    EXPECT_TRUE(c.store.values(ConfigLayer::flash).empty());
}

TEST(Valdel, RefusesToLeaveTheNextStartWithoutAMajorSystem) {
    Configured c;
    EXPECT_EQ(c.set(2, {{glonass_item, 1}, {0x10310018, 1}, {gps_item, 0}, {galileo_item, 0}}), Verdict::acknowledge);
    EXPECT_EQ(c.erase(2, {glonass_item}), Verdict::refuse);
    EXPECT_EQ(c.erase(2, {period_item}, 1, 1), Verdict::acknowledge);
    EXPECT_EQ(c.erase(2, {glonass_item}, 1, 3), Verdict::refuse);
    EXPECT_EQ(c.store.values(ConfigLayer::battery).size(), 4U);
    EXPECT_EQ(c.erase(2, {glonass_item, gps_item}), Verdict::acknowledge);
}

TEST(Valdel, HasTransactionsToo) {
    Configured c;
    c.store.set(in_battery, period_item, 200);
    c.store.set(in_battery, cycles_item, 2);
    EXPECT_EQ(c.erase(2, {period_item}, 1, 1), Verdict::acknowledge);
    EXPECT_EQ(c.store.values(ConfigLayer::battery).size(), 2U);
    EXPECT_EQ(c.erase(2, {cycles_item}, 1, 3), Verdict::acknowledge);
    EXPECT_TRUE(c.store.values(ConfigLayer::battery).empty());
    EXPECT_EQ(c.erase(2, {}, 1, 3), Verdict::refuse);
}

// RECEIVER.md 2.5: old receivers do not know these messages.
TEST(ValueConfig, ABoardMayRefuseOrKeepSilent) {
    Configured c;
    for (const auto& [support, said] : {std::pair(ValueConfigSupport::refuse, Verdict::refuse),
                                        std::pair(ValueConfigSupport::silence, Verdict::silence)}) {
        c.board.quirks.value_config = support;
        EXPECT_EQ(c.set(1, {{period_item, 200}}), said);
        EXPECT_EQ(c.values.valget(valget_payload(0, {period_item})).verdict, said);
        EXPECT_EQ(c.erase(2, {period_item}), said);
    }
    EXPECT_EQ(c.store.value(period_item), 1000U);
}

}  // namespace
}  // namespace skyloop::firmware
