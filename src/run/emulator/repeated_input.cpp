#include "run/emulator/repeated_input.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <optional>
#include <string_view>

#include "base/core/text_file.hpp"
#include "detail/recorded_numbers.hpp"

namespace skyloop {
namespace {

struct InputLine {
    std::int64_t gps_ns = 0;
    std::uint64_t offset = 0, length = 0;
};

std::optional<InputLine> read_line(std::string_view text) {
    const auto numbers = recorded_numbers<3>(text);
    if (!numbers || (*numbers)[1] < 0 || (*numbers)[2] < 0) return std::nullopt;
    return InputLine{(*numbers)[0], static_cast<std::uint64_t>((*numbers)[1]),
                     static_cast<std::uint64_t>((*numbers)[2])};
}

Result<void> add_port(const std::filesystem::path& folder, std::size_t wire, firmware::PortId port,
                      std::vector<HeardBytes>& all) {
    const std::filesystem::path times = folder / fmt::format("port{}.in_times", wire);
    const auto text = read_text_file(times);
    if (!text) return fail(text.error());
    const auto bytes = read_text_file(folder / fmt::format("port{}.in", wire), std::size_t{1} << 30);
    if (!bytes) return fail(bytes.error());
    std::size_t number = 0;
    for (std::size_t at = 0; at < text->size();) {
        const std::size_t end = text->find('\n', at);
        // A run that was killed may have left half a line behind.
        if (end == std::string::npos) break;
        const auto line = read_line(std::string_view(*text).substr(at, end - at));
        at = end + 1;
        ++number;
        if (!line || line->offset > bytes->size() || line->length > bytes->size() - line->offset)
            return fail(ErrorCode::input, fmt::format("{}:{}: expected nanoseconds, offset and length of bytes of {}",
                                                      times.string(), number, fmt::format("port{}.in", wire)));
        const auto from = bytes->begin() + static_cast<std::ptrdiff_t>(line->offset);
        all.push_back({GpsTime(Nanoseconds(line->gps_ns)), wire, port,
                       Bytes(from, from + static_cast<std::ptrdiff_t>(line->length))});
    }
    return {};
}

}  // namespace

Result<std::vector<HeardBytes>> read_repeated_input(const std::filesystem::path& folder,
                                                    const std::vector<firmware::PortId>& ports) {
    std::vector<HeardBytes> all;
    for (std::size_t wire = 0; wire < ports.size(); ++wire)
        if (const auto added = add_port(folder, wire, ports[wire], all); !added) return fail(added.error());
    std::stable_sort(all.begin(), all.end(), [](const HeardBytes& a, const HeardBytes& b) { return a.at < b.at; });
    return all;
}

}  // namespace skyloop
