#include <fmt/format.h>

#include <algorithm>
#include <array>

#include "base/core/lowered_text.hpp"
#include "detail/track_formats.hpp"

namespace skyloop {
namespace {

struct NamedFlightLog {
    std::string_view ending, expected;
};
constexpr std::array named_flight_logs{
    NamedFlightLog{".ulg", "a PX4 log, which begins with 55 4c 6f 67"},
    NamedFlightLog{".bin", "an ArduPilot log, which begins with a3 95"},
    NamedFlightLog{".tlog", "a MAVLink log, which begins with a time of eight bytes and fe or fd"},
    NamedFlightLog{".ubx", "a UBX log with NAV-PVT, NAV-PVAT, NAV-HPPOSLLH, NAV-POSLLH or NAV-SOL"}};

const NamedFlightLog* named_flight_log(const std::string& name) {
    const std::string lower = lowered_text(name);
    const auto found = std::find_if(named_flight_logs.begin(), named_flight_logs.end(),
                                    [&](const NamedFlightLog& log) { return lower.ends_with(log.ending); });
    return found == named_flight_logs.end() ? nullptr : &*found;
}

}  // namespace

bool is_named_flight_log(const TrackFile& file) { return named_flight_log(file.name) != nullptr; }

Result<Track> refuse_flight_log(const TrackFile& file) {
    constexpr std::size_t most_shown = 8;
    std::string begin;
    for (const std::uint8_t byte : file.bytes.first(std::min(file.bytes.size(), most_shown)))
        begin += fmt::format("{}{:02x}", begin.empty() ? "" : " ", byte);
    return fail(ErrorCode::input,
                fmt::format("{}: {}; expected {}", file.name, begin.empty() ? "is empty" : "begins with " + begin,
                            named_flight_log(file.name)->expected));
}

}  // namespace skyloop
