#include "receiver/observed/observed_log.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <string_view>
#include <utility>

#include "base/core/std_additions.hpp"
#include "detail/observed_parts.hpp"
#include "receiver/observed/dataflash.hpp"
#include "receiver/observed/ulog.hpp"
#include "receiver/protocol/nmea_sentence.hpp"
#include "receiver/protocol/sbf_cartesian_blocks.hpp"
#include "receiver/protocol/ubx_inertial.hpp"
#include "receiver/protocol/ubx_nav.hpp"

namespace skyloop::inline receiver {
namespace {

// By the clock of epochs with a fix, where there are any: that of a receiver without one may be anything.
GpsTime middle_time(const std::vector<ObservedEpoch>& epochs) {
    std::vector<GpsTime> times, of_fixes;
    for (const ObservedEpoch& epoch : epochs) {
        times.push_back(epoch.time);
        if (!epoch.is_lost()) of_fixes.push_back(epoch.time);
    }
    return middle_of(of_fixes.empty() ? times : of_fixes);
}

}  // namespace

int observed_number(std::optional<double> value) {
    constexpr double most = 65535;
    return value && *value >= 0 && *value <= most ? static_cast<int>(*value) : 0;
}

std::optional<Geodetic> observed_place(double latitude_deg, double longitude_deg, double height_m) {
    // 0, 0 is where receivers put what they do not know.
    if (latitude_deg == 0 && longitude_deg == 0) return std::nullopt;
    const auto place = place_from_degrees(latitude_deg, longitude_deg, height_m);
    return place ? std::optional(*place) : std::nullopt;
}

void add_signal(std::vector<ObservedSignal>& signals, const ObservedSignal& signal) {
    if (!(signal.cn0_dbhz > 0)) return;
    const auto at = std::lower_bound(signals.begin(), signals.end(), signal, [](const auto& a, const auto& b) {
        return std::pair(a.id, a.number) < std::pair(b.id, b.number);
    });
    if (at == signals.end() || at->id != signal.id || at->number != signal.number) {
        signals.insert(at, signal);
        return;
    }
    at->cn0_dbhz = std::max(at->cn0_dbhz, signal.cn0_dbhz);
    if (signal.elevation_deg) at->elevation_deg = signal.elevation_deg;
}

void add_note(ObservedLog& log, std::size_t count, const std::string& what) {
    if (count > 0) log.notes.push_back(fmt::format("{} {}", count, what));
}

namespace {

// Receivers put what they do not know at 0°, 0°, and repeat the last place without a fix.
void leave_out_places(ObservedLog& log) {
    std::size_t placeless = 0;
    for (ObservedEpoch& epoch : log.epochs) {
        const bool zero = epoch.place && epoch.place->latitude.deg() == 0 && epoch.place->longitude.deg() == 0;
        const bool fixed = epoch.type != FixType::none && epoch.type != FixType::time_only;
        if (zero || !fixed) epoch.place.reset();
        if (!epoch.place) epoch.velocity.reset(), epoch.attitude.reset();
        // Of a place in two parts the height is missing, which is told otherwise.
        if (fixed && !epoch.place && !epoch.motion.latitude) ++placeless;
    }
    add_note(log, placeless, "epochs have a fix and no sensible place");
}

}  // namespace

Result<ObservedLog> finish_log(ObservedLog log, const ObservedReading& reading) {
    constexpr auto longest = std::chrono::hours(7 * 24);
    leave_out_places(log);
    std::vector<ObservedEpoch>& epochs = log.epochs;
    if (reading.use == ObservedUse::fixes) return log;
    std::erase_if(epochs, [](const ObservedEpoch& epoch) { return !epoch.timed; });
    if (!epochs.empty()) {
        const GpsTime middle = middle_time(epochs);
        const auto astray = [&](const ObservedEpoch& e) { return std::chrono::abs(e.time - middle) > longest; };
        add_note(log, std::erase_if(epochs, astray), "epochs more than a week from the middle one were left out");
    }
    if (reading.use == ObservedUse::events) put_epochs_in_order(log);
    if (epochs.empty())
        return fail(ErrorCode::input,
                    fmt::format("{}: no epoch of a receiver with a date and time ({}); expected NAV-PVT, NAV-SOL or "
                                "NAV-TIMEGPS, RMC and GGA, PVTGeodetic, vehicle_gps_position or GPS records",
                                log.name, log.format));
    return log;
}

namespace {

// Any whole message with a place, after whatever else a receiver sends. None is longer than this.
constexpr std::size_t longest_place = 256;
constexpr std::array ubx_places{NavPvt::message_id, NavPvat::message_id, NavPosllh::message_id, NavSol::message_id,
                                NavHpposllh::message_id};

bool is_ubx_place(ByteSpan bytes) {
    constexpr std::size_t length_at = 4;
    if (bytes.size() < ubx_head_size || bytes[0] != ubx_sync_1 || bytes[1] != ubx_sync_2) return false;
    const UbxMessageId id{bytes[2], bytes[3]};
    const std::size_t size =
        ubx_head_size + ubx_tail_size + bytes[length_at] + (std::size_t{bytes[length_at + 1]} << 8);
    return size <= std::min(bytes.size(), longest_place) &&
           std::find(ubx_places.begin(), ubx_places.end(), id) != ubx_places.end() && parse_frame(bytes.first(size));
}

bool is_sbf_place(ByteSpan bytes) {
    if (bytes.size() < sbf_head_size || bytes[0] != sbf_sync_1 || bytes[1] != sbf_sync_2) return false;
    const auto size = sbf_block_size(bytes);
    const auto block =
        size && *size <= std::min(bytes.size(), longest_place) ? parse_sbf(bytes.first(*size)) : std::nullopt;
    return block && (block->number == SbfPvtGeodetic::block_number || block->number == SbfPvtCartesian::block_number);
}

}  // namespace

bool holds_messages(ByteSpan bytes) {
    for (std::size_t at = 0; at < bytes.size(); ++at)
        if (is_ubx_place(bytes.subspan(at)) || is_sbf_place(bytes.subspan(at))) return true;
    return false;
}

bool holds_sentences(ByteSpan bytes) {
    constexpr std::size_t looked_at = 65536;
    constexpr std::array<std::string_view, 8> kinds{"RMC", "GGA", "GNS", "GLL", "GSA", "GSV", "VTG", "ZDA"};
    std::string_view text(reinterpret_cast<const char*>(bytes.data()), std::min(bytes.size(), looked_at));
    for (; !text.empty(); text.remove_prefix(std::min(text.find('\n'), text.size() - 1) + 1)) {
        const std::string_view line = text.substr(0, text.find('\n'));
        const auto sentence = parse_sentence(line.substr(std::min(line.find('$'), line.size())));
        if (sentence && sentence->address.size() == 5 &&
            std::find(kinds.begin(), kinds.end(), sentence->address.substr(2)) != kinds.end())
            return true;
    }
    return false;
}

bool is_observed(ByteSpan bytes) {
    return is_ulog(bytes) || is_dataflash(bytes) || holds_messages(bytes) || holds_sentences(bytes) ||
           is_rtklib_solution(bytes);
}

Result<ObservedLog> read_observed(ByteSpan bytes, const std::string& name, const ObservedReading& reading) {
    if (bytes.empty()) return fail(ErrorCode::input, fmt::format("{}: is empty; expected a receiver's log", name));
    if (is_ulog(bytes)) return read_ulog(bytes, name, reading);
    if (is_dataflash(bytes)) return read_dataflash(bytes, name, reading);
    if (holds_messages(bytes) || holds_sentences(bytes) || !is_rtklib_solution(bytes))
        return read_observed_stream(bytes, name, reading);
    return read_rtklib_solution(bytes, name, reading);
}

}  // namespace skyloop::inline receiver
