// Lines of whole numbers, as recordings hold them.
#include "run/emulator/read_recording.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <string_view>

#include "base/core/bytes.hpp"
#include "base/core/files.hpp"

namespace skyloop::inline run {

namespace {

// The numbers of a line, one space between them; nothing when there are others than `Count` or anything else.
template <std::size_t Count>
std::optional<std::array<std::int64_t, Count>> recorded_numbers(std::string_view line) {
    std::array<std::int64_t, Count> numbers{};
    for (std::size_t i = 0; i < Count; ++i) {
        if (i > 0 && !line.starts_with(' ')) return std::nullopt;
        if (i > 0) line.remove_prefix(1);
        const auto [end, error] = std::from_chars(line.data(), line.data() + line.size(), numbers[i]);
        if (error != std::errc()) return std::nullopt;
        line.remove_prefix(static_cast<std::size_t>(end - line.data()));
    }
    return line.empty() ? std::optional(numbers) : std::nullopt;
}

// Calls `each` with the number of every whole line, from 1, and its numbers; ends at the first Error.
// @return whether a run that was killed has left half a line behind
template <std::size_t Count, class Each>
Result<bool> read_number_lines(std::string_view text, const Each& each) {
    for (std::size_t number = 1; !text.empty(); ++number) {
        const std::size_t end = text.find('\n');
        if (end == std::string_view::npos) return true;
        if (const Result<void> taken = each(number, recorded_numbers<Count>(text.substr(0, end))); !taken)
            return fail(taken.error());
        text.remove_prefix(end + 1);
    }
    return false;
}

constexpr std::size_t most_recorded_bytes = std::size_t{1} << 30;

// What is wrong with a line; empty: nothing.
std::string wrong_with(const std::array<std::int64_t, 4>& line, const RecordedPort& port) {
    const auto [at, gps, offset, length] = line;
    const RecordedWrite last = port.writes.empty() ? RecordedWrite{} : port.writes.back();
    const auto expected = static_cast<std::int64_t>(last.offset + last.length);
    // A century: later sums stay far from the ends of the numbers.
    constexpr std::int64_t most_ns = 3'000'000'000'000'000'000;
    if (at < 0 || at > most_ns) return fmt::format("the time {} ns is no time of a recording", at);
    if (!port.writes.empty() && at < last.at.count())
        return fmt::format("the time {} ns is before the {} ns of the line before", at, last.at.count());
    if (offset != expected) return fmt::format("found offset {}; expected {}, the next byte", offset, expected);
    if (length <= 0) return fmt::format("found length {}; expected more than 0", length);
    const std::uint64_t end = static_cast<std::uint64_t>(offset) + static_cast<std::uint64_t>(length);
    if (end > port.bytes.size())
        return fmt::format("tells of bytes up to {}, but only {} were recorded", end, port.bytes.size());
    return {};
}

void warn_of_the_end(RecordedPort& port, bool half_a_line, std::string_view name) {
    const std::size_t timed = port.writes.empty() ? 0 : port.writes.back().offset + port.writes.back().length;
    const std::size_t left = port.bytes.size() - timed;
    if (half_a_line || left > 0)
        port.warning = fmt::format("{}: the recording was cut short: {}{} bytes without a time are left out", name,
                                   half_a_line ? "its last line is not whole, " : "", left);
}

Result<RecordedPort> read_port(const std::filesystem::path& folder, std::size_t number) {
    const std::filesystem::path times_file = folder / fmt::format("port{}.times", number);
    const auto times = read_text_file(times_file, most_recorded_bytes);
    if (!times) return fail(times.error());
    const auto out = read_text_file(folder / fmt::format("port{}.out", number), most_recorded_bytes);
    if (!out) return fail(out.error());
    return read_recorded_times(*times, to_bytes(*out), times_file.string());
}

}  // namespace

Result<RecordedPort> read_recorded_times(std::string_view times, Bytes bytes, std::string_view name) {
    RecordedPort port;
    port.bytes = std::move(bytes);
    const auto half_a_line = read_number_lines<4>(times, [&](std::size_t number, const auto& line) -> Result<void> {
        const std::string wrong =
            line ? wrong_with(*line, port) : "expected monotonic nanoseconds, GPS nanoseconds, offset and length";
        if (!wrong.empty()) return fail(ErrorCode::input, fmt::format("{}:{}: {}", name, number, wrong));
        port.writes.push_back(
            {Nanoseconds((*line)[0]), static_cast<std::size_t>((*line)[2]), static_cast<std::size_t>((*line)[3])});
        return {};
    });
    if (!half_a_line) return fail(half_a_line.error());
    warn_of_the_end(port, *half_a_line, name);
    return port;
}

Result<std::vector<RecordedPort>> read_recorded_output(const std::filesystem::path& folder) {
    std::vector<RecordedPort> ports;
    std::error_code error;
    do {
        auto port = read_port(folder, ports.size());
        if (!port) return fail(port.error());
        ports.push_back(std::move(*port));
    } while (std::filesystem::exists(folder / fmt::format("port{}.out", ports.size()), error));
    return ports;
}

RecordedPort paced_output(Bytes bytes, std::uint32_t baud) {
    constexpr std::size_t bits = SerialFormat{}.bits_per_byte();
    const std::size_t a_millisecond = std::max<std::size_t>(baud / (bits * 1000), 1);
    RecordedPort port;
    port.bytes = std::move(bytes);
    for (std::size_t at = 0; at < port.bytes.size(); at += a_millisecond) {
        const std::size_t length = std::min(a_millisecond, port.bytes.size() - at);
        // Below 2^63 for all that memory can hold: 2^30 bytes at 1 bit/s are 10^19 ns, so in floating point.
        const double seconds = static_cast<double>((at + length) * bits) / static_cast<double>(baud);
        port.writes.push_back({Nanoseconds(std::llround(seconds * 1e9)), at, length});
    }
    return port;
}

Result<std::vector<RecordedPort>> part_of(std::vector<RecordedPort> ports, Nanoseconds from, Nanoseconds duration) {
    Nanoseconds first = Nanoseconds::max(), last = Nanoseconds(0);
    for (const RecordedPort& port : ports) {
        if (port.writes.empty()) continue;
        first = std::min(first, port.writes.front().at);
        last = std::max(last, port.writes.back().at);
    }
    if (first == Nanoseconds::max()) return fail(ErrorCode::usage, "nothing was sent in this recording");
    bool any = false;
    for (RecordedPort& port : ports) {
        std::erase_if(port.writes, [&](const RecordedWrite& write) {
            const Nanoseconds since = write.at - first;
            return since < from || since - from >= duration;
        });
        for (RecordedWrite& write : port.writes)
            write.at -= first + from;
        any = any || !port.writes.empty();
    }
    if (!any)
        return fail(ErrorCode::usage, fmt::format("nothing was sent from {:.3f} s on; the recording is {:.3f} s long",
                                                  to_seconds(from).value(), to_seconds(last - first).value()));
    return ports;
}

namespace {

Result<void> add_port(const std::filesystem::path& folder, std::size_t wire, firmware::PortId port,
                      std::vector<HeardBytes>& all) {
    const std::filesystem::path times = folder / fmt::format("port{}.in_times", wire);
    const auto text = read_text_file(times);
    if (!text) return fail(text.error());
    const auto bytes = read_text_file(folder / fmt::format("port{}.in", wire), std::size_t{1} << 30);
    if (!bytes) return fail(bytes.error());
    const auto read = read_number_lines<3>(*text, [&](std::size_t number, const auto& line) -> Result<void> {
        const auto [gps_ns, offset, length] = line.value_or(std::array<std::int64_t, 3>{0, -1, -1});
        const auto size = static_cast<std::int64_t>(bytes->size());
        if (offset < 0 || length < 0 || offset > size || length > size - offset)
            return fail(ErrorCode::input, fmt::format("{}:{}: expected nanoseconds, offset and length of bytes of {}",
                                                      times.string(), number, fmt::format("port{}.in", wire)));
        const auto from = bytes->begin() + offset;
        all.push_back({GpsTime(Nanoseconds(gps_ns)), wire, port, Bytes(from, from + length)});
        return {};
    });
    return read ? Result<void>() : fail(read.error());
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

}  // namespace skyloop::inline run
