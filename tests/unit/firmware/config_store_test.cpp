#include "firmware/ublox/config/config_store.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <random>

#include "config_support.hpp"

namespace skyloop::firmware {
namespace {

using testing::HasSubstr;

constexpr std::uint32_t elevation_item = key::navspg_min_elev, monitor_item = key::itfm_enable;

ConfigStore small_store() { return ConfigStore({{period_item, 1000}, {elevation_item, 5}, {monitor_item, 0}}); }

TEST(ConfigStore, RamBeginsAsTheFactory) {
    const ConfigStore store = small_store();
    EXPECT_EQ(store.value(period_item), 1000U);
    EXPECT_EQ(store.stored(ConfigLayer::ram, period_item), 1000U);
    EXPECT_EQ(store.stored(ConfigLayer::factory, period_item), 1000U);
    EXPECT_EQ(store.stored(ConfigLayer::battery, period_item), std::nullopt);
    EXPECT_EQ(store.stored(ConfigLayer::flash, period_item), std::nullopt);
}

TEST(ConfigStore, KnowsItemsByTheirWholeId) {
    ConfigStore store = small_store();
    EXPECT_TRUE(store.has(0x30210001));
    EXPECT_FALSE(store.has(0x40210001));
    EXPECT_FALSE(store.has(key::rate_nav));
    store.set(in_ram | in_flash, 0x40210001, 7);
    store.set(in_ram | in_flash, key::rate_nav, 7);
    EXPECT_EQ(store.value(period_item), 1000U);
    EXPECT_EQ(store.value(0x40210001), 0U);
    EXPECT_EQ(store.value(key::rate_nav), 0U);
    EXPECT_TRUE(store.values(ConfigLayer::flash).empty());
}

TEST(ConfigStore, CutsValuesToTheirSize) {
    ConfigStore store = small_store();
    store.set(in_ram, period_item, 0x12345);
    EXPECT_EQ(store.value(period_item), 0x2345U);
    store.set(in_ram, monitor_item, 0xFE);  // of a logical only bit 0 counts
    EXPECT_FALSE(store.flag(monitor_item));
    store.set(in_ram, monitor_item, 3);
    EXPECT_EQ(store.value(monitor_item), 1U);
    store.set(in_ram, elevation_item, static_cast<std::uint64_t>(-7));
    EXPECT_EQ(store.value(elevation_item), 0xF9U);
    EXPECT_EQ(store.signed_value(elevation_item), -7);
    EXPECT_EQ(cut_to_size(0x50360006, ~std::uint64_t{0}), ~std::uint64_t{0});
}

TEST(ConfigStore, AStartOverlaysFlashWithTheBattery) {
    ConfigStore store = small_store();
    store.set(in_flash, period_item, 500);
    store.set(in_flash, elevation_item, 10);
    store.set(in_battery, period_item, 200);
    EXPECT_EQ(store.value(period_item), 1000U);  // what is saved does nothing before the next start
    store.reload();
    EXPECT_EQ(store.value(period_item), 200U);
    EXPECT_EQ(store.value(elevation_item), 10U);
    store.erase(in_battery, period_item);
    store.reload();
    EXPECT_EQ(store.value(period_item), 500U);
    store.clear(in_flash);
    store.reload();
    EXPECT_EQ(store.value(period_item), 1000U);
    EXPECT_EQ(store.value(elevation_item), 5U);
}

TEST(ConfigStore, RamForgetsNothing) {
    ConfigStore store = small_store();
    store.set(in_ram, period_item, 100);
    store.erase(in_ram, period_item);
    store.clear(in_ram);
    EXPECT_EQ(store.value(period_item), 100U);
    store.reload();  // but it is not kept
    EXPECT_EQ(store.value(period_item), 1000U);
}

TEST(ConfigStore, TheRevisionGrowsWithChangesOfRamAlone) {
    ConfigStore store = small_store();
    const auto first = store.revision();
    store.set(in_battery | in_flash, period_item, 100);
    store.set(in_ram, period_item, 1000);
    EXPECT_EQ(store.revision(), first);
    store.set(in_ram, period_item, 200);
    const auto second = store.revision();
    EXPECT_GT(second, first);
    store.reload();
    const auto third = store.revision();
    EXPECT_GT(third, second);
    store.reload();
    EXPECT_EQ(store.revision(), third);
}

TEST(ConfigStore, GivesRatesByMessageAndPort) {
    ConfigStore store(factory_config(whole_board()));
    constexpr UbxMessageId pvt{0x01, 0x07};
    EXPECT_EQ(store.rate(pvt, PortId::uart1), 0);
    store.set(in_ram, 0x20910007, 3);
    EXPECT_EQ(store.rate(pvt, PortId::uart1), 3);
    EXPECT_EQ(store.rate(pvt, PortId::usb), 0);
    EXPECT_EQ(store.rate({0xF0, 0x03}, PortId::spi), 5);
    EXPECT_EQ(store.rate({0x0A, 0x04}, PortId::uart1), 0);
}

TEST(ConfigStore, OutlivesTheProcessAsText) {
    ConfigStore store = small_store();
    store.set(in_battery, period_item, 200);
    store.set(in_flash, elevation_item, static_cast<std::uint64_t>(-3));
    EXPECT_EQ(store.persistent_text(), "battery CFG-RATE-MEAS 200\nflash CFG-NAVSPG-INFIL_MINELEV 253\n");
    ConfigStore next = small_store();
    next.set(in_flash, period_item, 50);  // what it held before is gone
    ASSERT_TRUE(next.restore(store.persistent_text(), "state.txt"));
    EXPECT_EQ(next.persistent_text(), store.persistent_text());
    EXPECT_EQ(next.value(period_item), 200U);
    EXPECT_EQ(next.signed_value(elevation_item), -3);
}

TEST(ConfigStore, RefusesATextThatIsNoneOfItsOwnAndKeepsWhatItHas) {
    ConfigStore store = small_store();
    store.set(in_flash, period_item, 50);
    const auto refusal = [&store](std::string_view text) {
        const auto read = store.restore(text, "state.txt");
        EXPECT_EQ(store.stored(ConfigLayer::flash, period_item), 50U);
        EXPECT_EQ(store.value(period_item), 1000U);
        return read ? "accepted" : read.error().message;
    };
    EXPECT_EQ(refusal("\nram CFG-RATE-MEAS 1"), "state.txt:2: layer 'ram'; expected battery or flash");
    EXPECT_EQ(refusal("flash CFG-RATE-NAV 1"), "state.txt:1: 'CFG-RATE-NAV' is no configuration item of this receiver");
    EXPECT_EQ(refusal("flash CFG-RATE-MEAS 65536"),
              "state.txt:1: CFG-RATE-MEAS is '65536'; expected a whole number of 2 bytes");
    EXPECT_THAT(refusal("flash CFG-RATE-MEAS"), HasSubstr("is ''; expected a whole number"));
    EXPECT_THAT(refusal("flash CFG-RATE-MEAS -1"), HasSubstr("is '-1'; expected a whole number"));
    EXPECT_THAT(refusal("flash CFG-RATE-MEAS 1 2"), HasSubstr("text after the value"));
}

TEST(ConfigStore, RefusesWhatItsJudgeDoesNotAllow) {
    ConfigStore store = small_store();
    const auto allows = [](std::uint32_t key, std::uint64_t value) { return key != period_item || value >= 100; };
    const auto read = store.restore("flash CFG-RATE-MEAS 100\nbattery CFG-RATE-MEAS 99", "state.txt", allows);
    ASSERT_FALSE(read);
    EXPECT_EQ(read.error().code, ErrorCode::input);
    EXPECT_EQ(read.error().message, "state.txt:2: CFG-RATE-MEAS is 99, which this receiver itself would refuse");
    EXPECT_EQ(store.stored(ConfigLayer::flash, period_item), std::nullopt);
    EXPECT_TRUE(store.restore("flash CFG-RATE-MEAS 100", "state.txt", allows));
    EXPECT_EQ(store.value(period_item), 100U);
}

TEST(ConfigStore, RefusesALayerThatTheReceiverDoesNotHave) {
    ConfigStore store = small_store();
    const auto read = store.restore("battery CFG-RATE-MEAS 100\nflash CFG-RATE-MEAS 200", "state.txt", {}, in_battery);
    ASSERT_FALSE(read);
    EXPECT_EQ(read.error().message, "state.txt:2: layer 'flash', which this receiver does not have");
    EXPECT_EQ(store.value(period_item), 1000U);
    EXPECT_TRUE(store.restore("battery CFG-RATE-MEAS 100", "state.txt", {}, in_battery));
    EXPECT_EQ(store.value(period_item), 100U);
}

// Whatever is done to the layers, RAM holds every item of the factory, a start gives battery over flash over factory,
// and the text restores both layers.
TEST(ConfigStore, LayersKeepTheirLawsUnderAnyOperations) {
    const ConfigValues factory = factory_config(whole_board());
    std::vector<std::uint32_t> keys;
    for (const auto& [key, value] : factory)
        keys.push_back(key);
    std::mt19937 random(7);
    ConfigStore store(factory);
    for (int step = 0; step < 2000; ++step) {
        const std::uint32_t key = keys[random() % keys.size()];
        const auto layers = static_cast<ConfigLayers>(random() % 8);
        const auto operation = random() % 10;
        if (operation < 6) store.set(layers, key, random());
        if (operation == 6) store.erase(layers, key);
        if (operation == 7 && step % 50 == 0) store.clear(layers);
        if (operation > 7) store.reload();
        ASSERT_EQ(store.values(ConfigLayer::ram).size(), factory.size());
        ASSERT_EQ(store.values(ConfigLayer::factory), factory);
        if (operation <= 7) continue;
        for (const std::uint32_t k : {key, keys[random() % keys.size()]}) {
            const auto flash = store.stored(ConfigLayer::flash, k), battery = store.stored(ConfigLayer::battery, k);
            ASSERT_EQ(store.value(k), battery.value_or(flash.value_or(factory.at(k))));
        }
    }
    ConfigStore copy(factory);
    ASSERT_TRUE(copy.restore(store.persistent_text(), "text"));
    EXPECT_EQ(copy.values(ConfigLayer::flash), store.values(ConfigLayer::flash));
    EXPECT_EQ(copy.values(ConfigLayer::battery), store.values(ConfigLayer::battery));
}

}  // namespace
}  // namespace skyloop::firmware
