/// A zip archive of one file that is not compressed, byte by byte from PKWARE's APPNOTE 6.3, 4.3.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>

namespace skyloop::test {

inline std::uint32_t crc32_of(std::string_view text) {
    std::uint32_t crc = 0xffffffff;
    for (const char letter : text) {
        crc ^= static_cast<std::uint8_t>(letter);
        for (int bit = 0; bit < 8; ++bit)
            crc = (crc >> 1) ^ ((crc & 1) != 0 ? 0xedb88320 : 0);
    }
    return ~crc;
}

/// @param checked false: with a checksum of 0
inline std::string stored_zip(std::string_view name, std::string_view content, bool checked = true) {
    const auto number = [](std::uint64_t value, int bytes) {
        std::string text;
        for (int i = 0; i < bytes; ++i)
            text += static_cast<char>(value >> (8 * i));
        return text;
    };
    const std::string sizes = number(checked ? crc32_of(content) : 0, 4) + number(content.size(), 4) +
                              number(content.size(), 4) + number(name.size(), 2);
    const std::string versions = number(20, 2) + number(0, 2) + number(0, 2) + number(0, 2) + number(0x21, 2);
    std::string zip = "PK\x03\x04" + versions + sizes + number(0, 2) + std::string(name) + std::string(content);
    const std::size_t directory = zip.size();
    zip += "PK\x01\x02" + number(20, 2) + versions + sizes + number(0, 12) + number(0, 4) + std::string(name);
    zip += "PK\x05\x06" + number(0, 4) + number(1, 2) + number(1, 2) + number(zip.size() - directory, 4) +
           number(directory, 4) + number(0, 2);
    return zip;
}

}  // namespace skyloop::test
