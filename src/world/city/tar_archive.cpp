#include "detail/tar_archive.hpp"

#include <fmt/format.h>

#include <charconv>
#include <cstdint>
#include <optional>

#include "detail/city_text.hpp"

namespace skyloop {
namespace {

constexpr std::size_t tar_block = 512;

std::string_view tar_text(std::string_view field) { return field.substr(0, field.find('\0')); }

// Octal digits between blanks and zeros; GNU's binary sizes are beyond any city.
std::optional<std::uint64_t> tar_number(std::string_view field) {
    const std::size_t first = field.find_first_not_of(' ');
    if (first == std::string_view::npos) return std::nullopt;
    const std::string_view digits = field.substr(first);
    std::uint64_t value = 0;
    const auto [after, error] = std::from_chars(digits.data(), digits.data() + digits.size(), value, 8);
    if (error != std::errc{}) return std::nullopt;
    if (after != digits.data() + digits.size() && *after != ' ' && *after != '\0') return std::nullopt;
    return value;
}

// The sum of all bytes of the header, its own field taken as blanks.
bool tar_sum_fits(std::string_view header) {
    std::uint64_t sum = 0;
    for (std::size_t i = 0; i < tar_block; ++i)
        sum += i >= 148 && i < 156 ? std::uint64_t{' '} : static_cast<unsigned char>(header[i]);
    return tar_number(header.substr(148, 8)) == sum;
}

// The path of a pax record "LENGTH path=NAME\n"; empty without one.
std::string pax_path(std::string_view records) {
    std::string path;
    while (!records.empty()) {
        std::size_t length = 0;
        const auto [after, error] = std::from_chars(records.data(), records.data() + records.size(), length);
        const auto digits = static_cast<std::size_t>(after - records.data());
        if (error != std::errc{} || length <= digits + 1 || length > records.size()) break;
        const std::string_view record = records.substr(digits + 1, length - digits - 2);
        if (record.starts_with("path=")) path = record.substr(5);
        records.remove_prefix(length);
    }
    return path;
}

std::string tar_name(std::string_view header) {
    const std::string name(tar_text(header.substr(0, 100)));
    const std::string_view prefix = tar_text(header.substr(345, 155));
    if (header.substr(257, 5) != "ustar" || prefix.empty()) return name;
    return fmt::format("{}/{}", prefix, name);
}

}  // namespace

Result<std::map<std::string, std::string_view>> tar_members(std::string_view bytes, std::string_view name) {
    std::map<std::string, std::string_view> members;
    std::string next_name;
    for (std::size_t at = 0; at < bytes.size();) {
        if (bytes.size() - at < tar_block)
            return fail(ErrorCode::input, fmt::format("{}: byte {}: the archive ends in a header", name, at));
        const std::string_view header = bytes.substr(at, tar_block);
        if (header.find_first_not_of('\0') == std::string_view::npos) break;  // the end
        const auto size = tar_number(header.substr(124, 12));
        if (!tar_sum_fits(header) || !size)
            return fail(ErrorCode::input,
                        fmt::format("{}: byte {}: is no header of a tar archive, or damaged", name, at));
        at += tar_block;
        if (*size > bytes.size() - at)
            return fail(ErrorCode::input, fmt::format("{}: byte {}: a file of {} bytes, but the archive has {} left",
                                                      name, at, *size, bytes.size() - at));
        const std::string_view content = bytes.substr(at, *size);
        const std::size_t padded = (*size + tar_block - 1) / tar_block * tar_block;
        at += std::min<std::size_t>(padded, bytes.size() - at);
        const char kind = header[156];
        if (kind == 'L') {
            next_name = tar_text(content);
        } else if (kind == 'x') {
            next_name = pax_path(content);
        } else {
            const std::string told = next_name.empty() ? tar_name(header) : next_name;
            next_name.clear();
            const auto inside = name_inside(told);
            if ((kind == '0' || kind == '\0') && inside) members[*inside] = content;
        }
    }
    return members;
}

}  // namespace skyloop
