#include "detail/scenario_keys.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cctype>

#include "firmware/makers.hpp"
#include "firmware/septentrio/settings.hpp"
#include "firmware/ublox/config/config_handler.hpp"

namespace skyloop::inline run {
namespace {

using firmware::BoardProfile;
using firmware::MakerKind;
using firmware::PortId;
using firmware::SpeedChangeAnswer;
using firmware::ValueConfigSupport;

constexpr NumberRange speed_range{firmware::slowest_baud, firmware::fastest_baud};

// Texts of the start may name what MON-VER says.
std::vector<std::string> filled_in(const std::vector<std::string>& texts, const firmware::Identity& identity) {
    std::vector<std::string> filled;
    for (const std::string& text : texts) {
        if (text == "{extensions}")
            filled.insert(filled.end(), identity.extensions.begin(), identity.extensions.end());
        else if (text == "{software}")
            filled.push_back(identity.software);
        else
            filled.push_back(text);
    }
    return filled;
}

void read_board_identity(TableReader& table, firmware::Identity& identity) {
    table.integer("generation", identity.generation, {5, 20});
    table.text("software", identity.software);
    table.text("hardware", identity.hardware);
    table.texts("extensions", identity.extensions);
    table.texts("banner", identity.banner);
    table.texts("version_answers", identity.version_answers);
    // Sizes of MON-VER's fields (RECEIVER.md 2.1); the last character may not be cut.
    constexpr std::size_t field = 30, short_field = 10;
    if (identity.software.size() > field) table.mistake("software", "is longer than 30 characters");
    if (identity.hardware.size() > short_field) table.mistake("hardware", "is longer than 10 characters");
    for (const std::string& extension : identity.extensions)
        if (extension.size() > field)
            table.mistake("extensions", fmt::format("holds '{}'; expected at most 30 characters", extension));
    std::string digits;
    table.text("unique_id", digits);
    const auto bytes = bytes_of_hex(digits);
    if (!bytes || (!digits.empty() && bytes->size() != 5 && bytes->size() != 6))
        table.mistake("unique_id", fmt::format("is '{}'; expected five or six bytes in hexadecimal digits", digits));
    else
        identity.unique_id = *bytes;
    identity.banner = filled_in(identity.banner, identity);
}

// A word that stands in a list and is no path.
void read_aliases(TableReader& top, std::vector<std::string>& aliases) {
    top.texts("aliases", aliases);
    const auto is_plain = [](unsigned char c) { return std::isalnum(c) != 0 || c == '-' || c == '_'; };
    for (const std::string& alias : aliases)
        if (alias.empty() || !std::ranges::all_of(alias, is_plain))
            top.mistake("aliases", fmt::format("holds '{}'; expected letters, digits, '-' and '_'", alias));
}

void read_board_timing(TableReader& table, firmware::Timing& timing) {
    table.quantity("boot_s", timing.boot, {0, 60});
    table.quantity("first_epoch_s", timing.first_epoch, {0, 60});
    table.quantity("answer_s", timing.answer, {0, 10});
    table.quantity("flash_write_s", timing.flash_write, {0, 10});
    table.quantity("signal_restart_s", timing.signal_restart, {0, 60});
    table.quantity("latency_deviation_s", timing.latency_deviation, {0, 1});
    table.quantity("command_sleep_s", timing.command_sleep, {0, 60});
    table.quantity("coasting_s", timing.coasting, {0, 600});
    table.quantity("cold_start_s", timing.cold_start, {0, 3600});
    table.quantity("warm_start_s", timing.warm_start, {0, 3600});
    table.quantity("hot_start_s", timing.hot_start, {0, 3600});
}

void read_board_corrections(TableReader& table, firmware::CorrectionAbility& ability) {
    table.boolean("rtk", ability.rtk);
    table.quantity("float_after_s", ability.float_after, {0, 3600});
    table.quantity("fixed_after_s", ability.fixed_after, {0, 3600});
    table.quantity("fixed_held_s", ability.fixed_held, {0, 3600});
    table.quantity("float_held_s", ability.float_held, {0, 3600});
}

void read_board_power(TableReader& table, firmware::PowerAbility& power) {
    table.boolean("save_modes", power.save_modes);
    table.boolean("backup", power.backup);
    table.boolean("backup_needs_force", power.backup_needs_force);
    table.boolean("keeps_ram", power.keeps_ram);
    table.boolean("banner", power.banner);
    table.texts("texts", power.texts);
    table.quantity("wake_s", power.wake, {0, 60});
    table.quantity("acquisition_s", power.acquisition, {1, 3600});
    table.quantity("blind_acquisition_s", power.blind_acquisition, {0, 3600});
    table.quantity("search_margin_s", power.search_margin, {0, 60});
    table.quantity("download_s", power.download, {0, 600});
}

void read_board_quirks(TableReader& table, firmware::Quirks& quirks) {
    table.word("value_config",
               {{"full", ValueConfigSupport::full},
                {"refuse", ValueConfigSupport::refuse},
                {"silence", ValueConfigSupport::silence}},
               quirks.value_config);
    table.boolean("single_key_valget", quirks.single_key_valget);
    table.boolean("empty_valget_page", quirks.empty_valget_page);
    table.boolean("l5_health_by_version_1", quirks.l5_health_by_version_1);
    table.boolean("hardware_reset_clears_battery", quirks.hardware_reset_clears_battery);
    table.word("speed_change_answer",
               {{"at_new_speed", SpeedChangeAnswer::at_new_speed},
                {"at_old_speed", SpeedChangeAnswer::at_old_speed},
                {"lost", SpeedChangeAnswer::lost}},
               quirks.speed_change);
    table.boolean("answers_unknown_nmea", quirks.answers_unknown_nmea);
    table.boolean("interference_monitor", quirks.default_interference_monitor);
    table.boolean("voltage_control", quirks.voltage_control);
    table.integer("leap_seconds", quirks.leap_seconds, {0, 60});
}

void read_board_uart(TableReader& uart, BoardProfile& board) {
    uart.integer("baud", board.baud, speed_range);
    uart.integer("transmit_buffer_bytes", board.transmit_buffer_bytes, {128, 1'048'576});
    uart.integer("generated_ahead_bytes", board.generated_ahead_bytes, {0, 1'048'576});
    if (const auto speeds = uart.whole_numbers("bauds", speed_range)) {
        for (const std::int64_t speed : *speeds)
            board.bauds.push_back(static_cast<std::uint32_t>(speed));
        std::sort(board.bauds.begin(), board.bauds.end());
        if (std::find(board.bauds.begin(), board.bauds.end(), board.baud) == board.bauds.end())
            uart.mistake("bauds", fmt::format("does not hold uart.baud, {}", board.baud));
    }
    if (const auto ports = uart.choices("ports", firmware::port_names)) {
        board.ports.clear();
        for (const std::size_t port : *ports)
            board.ports.push_back(static_cast<PortId>(port));
        if (board.maker == MakerKind::ublox && std::ranges::count(board.ports, PortId::uart3) > 0)
            uart.mistake("ports", "has uart3, which no u-blox receiver has");
        std::sort(board.ports.begin(), board.ports.end());
    }
}

// A text that CFG-USB holds with a zero behind it.
void read_usb_text(TableReader& usb, std::string_view key, std::string& text) {
    constexpr std::size_t most_characters = 31;
    usb.text(key, text);
    const bool plain = std::all_of(text.begin(), text.end(), [](char c) { return c >= ' ' && c <= '~'; });
    if (text.size() > most_characters || !plain)
        usb.mistake(key, fmt::format("is '{}'; expected at most {} characters of ASCII", text, most_characters));
}

void read_board_usb(TableReader& usb, BoardProfile& board) {
    constexpr NumberRange sixteen_bits{0, 0xFFFF};
    firmware::UsbDescription description;
    const bool both = usb.has("vendor_id") && usb.has("product_id");
    usb.integer("vendor_id", description.vendor_id, sixteen_bits);
    usb.integer("product_id", description.product_id, sixteen_bits);
    usb.integer("release", description.release, sixteen_bits);
    read_usb_text(usb, "manufacturer", description.manufacturer);
    read_usb_text(usb, "product", description.product);
    read_usb_text(usb, "serial", description.serial);
    if (!both) usb.mistake_here("has not both vendor_id and product_id");
    board.usb = std::move(description);
}

void read_board_navigation(TableReader& navigation, BoardProfile& board) {
    read_constellation_list(navigation, "constellations", board.constellations);
    navigation.boolean("dual_frequency", board.dual_frequency);
    navigation.word("second_band", {{"l2", SecondBand::l2}, {"l5", SecondBand::l5}}, board.second_band);
    navigation.boolean("bands_together", board.bands_together);
    read_constellation_list(navigation, "first_band_alone", board.first_band_alone);
    navigation.integer("most_systems", board.most_systems, {1, 4});
    read_signal_conflicts(navigation, board);
    navigation.number("max_rate_hz", board.max_rate_hz, {0.1, 100});
    // A board slower than the usual rate starts at its own maximum.
    board.default_rate_hz = std::min(board.default_rate_hz, board.max_rate_hz);
    navigation.number("default_rate_hz", board.default_rate_hz, {0.1, board.max_rate_hz});
    navigation.number("all_satellites_rate_hz", board.all_satellites_rate_hz, {0, 100});
    navigation.integer("fast_satellites", board.fast_satellites, {4, 64});
    navigation.integer("least_measurement_period_ms", board.least_measurement_period_ms, {1, 65535});
    navigation.degrees("elevation_mask_deg", board.elevation_mask, {0, 90});
    board.dynamic_limits = board.maker == MakerKind::ublox;
    navigation.boolean("dynamic_limits", board.dynamic_limits);
    navigation.number("geoid_step_deg", board.geoid_step_deg, {0, 45});
    read_export_limits(navigation, board.export_limits);
    navigation.quantity("solution_latency_s", board.solution_latency, {0, 2});
}

// Blocks and groups, in the maker's spelling.
void read_board_sbf(TableReader& sbf, BoardProfile& board) {
    sbf.texts("blocks", board.sbf_blocks, {}, 0);
    for (std::string& name : board.sbf_blocks) {
        auto known = firmware::known_word(firmware::WordKind::block, name);
        if (!known) known = firmware::known_word(firmware::WordKind::block_group, name);
        if (!known) return sbf.mistake("blocks", fmt::format("has '{}', which is no SBF block or group", name));
        name = *known;
    }
}

// A u-blox receiver whose factory settings it would refuse itself could never be configured.
void check_factory_config(TableReader& top, const BoardProfile& board) {
    if (board.maker != MakerKind::ublox) return;
    const auto factory = firmware::factory_config(board);
    if (const auto* item = firmware::first_out_of_range(board, factory))
        return top.mistake_here(fmt::format("gives {} the factory value {}, which the receiver itself would refuse",
                                            firmware::find_config_key(item->first)->name, item->second));
    if (!firmware::is_consistent(board, factory))
        top.mistake_here("the factory settings do not go together: systems, signals, antenna supply");
}

void read_maker(TableReader& top, MakerKind& maker) {
    std::vector<std::string_view> names;
    for (const firmware::MakerRow& row : firmware::maker_rows())
        names.push_back(row.name);
    const auto index = top.choice("personality", names, {}, names.at(static_cast<std::size_t>(maker)));
    if (index) maker = static_cast<MakerKind>(*index);
}

void read_board_can(TableReader& table, firmware::CanNode& can) {
    constexpr std::size_t longest_name = 80;
    table.integer("node_id", can.node_id, {0, 125});
    table.text("name", can.name);
    if (can.name.empty() || can.name.size() > longest_name)
        table.mistake("name", fmt::format("has {} characters; expected 1 to {}", can.name.size(), longest_name));
    table.boolean("two_antennas", can.two_antennas);
}

// Tables that are one maker's alone.
void refuse_tables_of_others(TableReader& top, MakerKind maker) {
    const auto refuse = [&](std::string_view table, MakerKind owner, std::string_view what) {
        if (maker != owner && !top.recording() && top.has(table))
            top.mistake(table, fmt::format("has no effect: only receivers of the personality \"{}\" have {}",
                                           firmware::maker_row(owner).name, what));
    };
    refuse("config", MakerKind::ublox, "configuration items");
    refuse("sbf", MakerKind::sbf, "streams of blocks");
    refuse("dronecan", MakerKind::dronecan, "node ids");
}

}  // namespace

std::optional<Bytes> bytes_of_hex(std::string_view text) {
    constexpr std::string_view digits = "0123456789ABCDEF", small_digits = "0123456789abcdef";
    Bytes bytes;
    bool first = true;
    for (const char c : text) {
        if (c == ' ') continue;
        const std::size_t value = std::min(digits.find(c), small_digits.find(c));
        if (value == std::string_view::npos) return std::nullopt;
        if (first) bytes.push_back(0);
        bytes.back() = static_cast<std::uint8_t>(std::size_t{bytes.back()} << 4 | value);
        first = !first;
    }
    if (!first) return std::nullopt;
    return bytes;
}

void read_board_keys(TableReader& top, BoardProfile& board) {
    board.constellations = {Constellation::gps};
    std::string parent;
    top.text("extends", parent);  // that one has been laid under this
    top.text("description", board.description);
    read_aliases(top, board.aliases);
    top.texts("sources", board.sources);
    read_maker(top, board.maker);
    refuse_tables_of_others(top, board.maker);
    top.table("identity", [&](TableReader& t) { read_board_identity(t, board.identity); });
    top.table("timing", [&](TableReader& t) { read_board_timing(t, board.timing); });
    top.table("corrections", [&](TableReader& t) { read_board_corrections(t, board.corrections); });
    top.table("power", [&](TableReader& t) { read_board_power(t, board.power); });
    top.table("quirks", [&](TableReader& t) { read_board_quirks(t, board.quirks); });
    top.table("uart", [&](TableReader& t) { read_board_uart(t, board); });
    top.table("usb", [&](TableReader& t) { read_board_usb(t, board); });
    top.table("navigation", [&](TableReader& t) { read_board_navigation(t, board); });
    top.table("modern", [&](TableReader& t) {
        ModernSettings checked = ModernSettings::of(ModernPreset::consumer);
        read_modern_receiver_keys(t, checked);
        board.modern = t.toml_text();
    });
    top.table("nmea", [&](TableReader& t) { read_board_nmea(t, board); });
    top.table("ubx", [&](TableReader& t) { read_board_ubx(t, board); });
    top.table("sbf", [&](TableReader& t) { read_board_sbf(t, board); });
    top.table("dronecan", [&](TableReader& t) { read_board_can(t, board.can); });
    if (board.messages.empty())
        for (const std::string_view name : firmware::nmea_sentence_names)
            board.messages.push_back(firmware::find_output_message(name)->id);
    if (!top.has("config") && board.maker == firmware::MakerKind::ublox) leave_out_rates_of_others(board);
    top.table("config", [&](TableReader& t) { read_board_config(t, board); });
    check_factory_config(top, board);
}

}  // namespace skyloop::inline run
