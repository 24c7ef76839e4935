// CFG-CFG: clear, save and load (RECEIVER.md 3.3, 4.2, 4.3).
#include <optional>

#include "firmware/config/legacy_keys.hpp"
#include "firmware/config/legacy_support.hpp"
#include "receiver/protocol/ubx_cfg.hpp"

namespace skyloop::firmware {
namespace {

constexpr unsigned io_port = 0, msg_conf = 1, inf_msg = 2, nav_conf = 3, rxm_conf = 4, sen_conf = 8, rinv_conf = 9,
                   ant_conf = 10, log_conf = 11;

/// The bit of CFG-CFG's masks that an item belongs to (M8 interface description 32.11.3.1); what no bit names belongs
/// to the navigation.
unsigned section_of(std::uint32_t key) {
    const std::uint32_t group = key >> 16 & 0xFF;
    if (group == legacy_key::own_group) return key >> 8 & 0xF;
    if (group >= 0x71 && group <= 0x7A) return io_port;
    switch (group) {
        case 0x51:  // CFG-I2C, -UART1, -UART2, -SPI, -USB, -TXREADY
        case 0x52:
        case 0x53:
        case 0x64:
        case 0x65:
        case 0xA2:
            return io_port;
        case 0x91:
        case legacy_key::own_rate_group:
            return msg_conf;
        case 0x92:
            return inf_msg;
        case 0x05:  // CFG-TP, -SIGNAL, -SIGNAL health, -ITFM, -PM, -SEC
        case 0x31:
        case 0x32:
        case 0x41:
        case 0xD0:
        case 0xF6:
            return rxm_conf;
        case 0x06:  // CFG-SFIMU, -SFODO
        case 0x07:
            return sen_conf;
        case 0xC7:
            return rinv_conf;
        case 0xA3:
            return ant_conf;
        case 0xDE:
            return log_conf;
        default:
            return nav_conf;
    }
}

/// The items that a mask names. From generation 9 on any bit stands for all of them.
class SectionMask {
public:
    SectionMask(const LegacyContext& context, std::uint32_t mask)
        : mask_(mask != 0 && context.board.identity.generation >= 9 ? 0xFFFF'FFFFu : mask) {}
    [[nodiscard]] bool any() const { return mask_ != 0; }
    [[nodiscard]] bool has(std::uint32_t key) const { return (mask_ >> section_of(key) & 1) != 0; }

private:
    std::uint32_t mask_;
};

/// Memories that a device mask names: bit 0 battery-backed RAM, 1 flash, 2 EEPROM, 4 flash on SPI. Without a mask all.
/// What the board does not have is left out.
ConfigLayers layers_of(const BoardProfile& board, const std::optional<std::uint8_t>& device_mask) {
    const unsigned devices = device_mask.value_or(0x17);
    unsigned layers = 0;
    if ((devices & 0x01) != 0) layers |= in_battery;
    if ((devices & 0x16) != 0 && has_flash(board)) layers |= in_flash;
    return static_cast<ConfigLayers>(layers);
}

void load(const LegacyContext& context, const SectionMask& mask) {
    for (const auto& [key, factory] : ConfigValues(context.store.values(ConfigLayer::factory))) {
        if (!mask.has(key)) continue;
        const auto battery = context.store.stored(ConfigLayer::battery, key);
        const auto flash = context.store.stored(ConfigLayer::flash, key);
        const std::uint64_t value = battery ? *battery : flash.value_or(factory);
        if (context.store.value(key) != value) context.store.set(in_ram, key, value);
    }
}

}  // namespace

ConfigOutcome legacy_cfg(const LegacyContext& context, ByteSpan payload) {
    const auto set = decode_payload<CfgCfg>(payload);
    if (!set || is_locked(context)) return legacy_refused();
    const ConfigLayers layers = layers_of(context.board, set->device_mask);
    const SectionMask cleared(context, set->clear_mask), saved(context, set->save_mask),
        loaded(context, set->load_mask);
    for (const auto& [key, value] : ConfigValues(context.store.values(ConfigLayer::ram))) {
        if (cleared.has(key)) context.store.erase(layers, key);
        if (saved.has(key)) context.store.set(layers, key, value);
    }
    if (loaded.any()) load(context, loaded);
    const bool writes_flash = (layers & in_flash) != 0 && (cleared.any() || saved.any());
    return legacy_taken(writes_flash ? context.board.timing.flash_write : Seconds{0});
}

}  // namespace skyloop::firmware
