#include "wire/ntrip/source_table.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <numeric>

namespace skyloop::inline wire {
namespace {

std::string as_field(std::string text) {
    std::replace_if(
        text.begin(), text.end(), [](char c) { return c == ';' || static_cast<unsigned char>(c) < 0x20; }, ' ');
    return text;
}

}  // namespace

std::string source_line(const SourceRecord& r) {
    // The longitude counts east from 0 to 360° in version 1, and from -180 to 180° in version 2: readers take both.
    return fmt::format("STR;{};{};{};{};{};{};none;;{:.2f};{:.2f};{};{};skyloop;none;{};N;{};\r\n", as_field(r.mount),
                       as_field(r.identifier), as_field(r.format), as_field(r.details), r.carrier, as_field(r.systems),
                       r.latitude_deg, r.longitude_deg, r.wants_position ? 1 : 0, r.network ? 1 : 0,
                       r.needs_password ? "B" : "N", r.bit_rate);
}

std::string source_table(const std::vector<std::string>& lines) {
    return std::accumulate(lines.begin(), lines.end(), std::string()) + "ENDSOURCETABLE\r\n";
}

std::vector<std::string> mounts_of(std::string_view table) {
    constexpr std::string_view begin = "STR;";
    std::vector<std::string> mounts;
    while (!table.empty()) {
        const std::string_view line = table.substr(0, table.find('\n'));
        table.remove_prefix(std::min(line.size() + 1, table.size()));
        if (!line.starts_with(begin)) continue;
        const std::string_view rest = line.substr(begin.size());
        const std::size_t end = rest.find(';');
        if (end != std::string_view::npos && end > 0) mounts.emplace_back(rest.substr(0, end));
    }
    return mounts;
}

}  // namespace skyloop::inline wire
