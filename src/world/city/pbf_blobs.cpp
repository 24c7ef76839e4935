#include "detail/pbf_blobs.hpp"

#include <fmt/format.h>

#include <cstdint>
#include <exception>
#include <protozero/pbf_reader.hpp>
#include <string>

namespace skyloop {
namespace {

constexpr std::size_t length_bytes = 4, longest_header = std::size_t{64} << 10;
constexpr std::int64_t longest_blob = std::int64_t{32} << 20;

struct BlobHeader {
    std::string type;
    std::int64_t size = 0;  // of the blob behind it
};

// Fields 1, type, and 3, datasize. Throws what protozero throws.
BlobHeader blob_header(std::string_view bytes) {
    constexpr protozero::pbf_tag_type type_tag = 1, size_tag = 3;
    BlobHeader header;
    protozero::pbf_reader reader(bytes.data(), bytes.size());
    while (reader.next()) {
        if (reader.tag_and_type() == protozero::tag_and_type(type_tag, protozero::pbf_wire_type::length_delimited))
            header.type = reader.get_string();
        else if (reader.tag_and_type() == protozero::tag_and_type(size_tag, protozero::pbf_wire_type::varint))
            header.size = reader.get_int32();
        else
            reader.skip();
    }
    return header;
}

std::size_t big_endian(std::string_view bytes) {
    std::size_t value = 0;
    for (const char byte : bytes.substr(0, length_bytes))
        value = value << 8 | static_cast<unsigned char>(byte);
    return value;
}

}  // namespace

Result<void> check_pbf_blobs(std::string_view bytes, std::string_view name) {
    const auto refuse = [&](std::size_t at, std::string_view what) {
        return fail(ErrorCode::input, fmt::format("{}: damaged or cut at byte {}: {}", name, at, what));
    };
    for (std::size_t at = 0; at < bytes.size();) {
        const std::string_view rest = bytes.substr(at);
        if (rest.size() < length_bytes) return refuse(at, "the length of a blob's header is not whole");
        const std::size_t length = big_endian(rest);
        if (length > longest_header) return refuse(at, "the header of a blob is longer than 64 kB");
        if (rest.size() - length_bytes < length) return refuse(at, "the header of a blob is not whole");
        BlobHeader header;
        try {
            header = blob_header(rest.substr(length_bytes, length));
        } catch (const std::exception&) {
            return refuse(at, "the header of a blob cannot be read");
        }
        if (header.type.empty()) return refuse(at, "a blob has no type; expected OSMHeader or OSMData");
        if (header.size <= 0 || header.size > longest_blob)
            return refuse(at, fmt::format("a blob of {} bytes; expected 1 to 32 MB", header.size));
        const std::size_t begin = length_bytes + length;
        if (rest.size() - begin < static_cast<std::size_t>(header.size)) return refuse(at, "a blob is not whole");
        at += begin + static_cast<std::size_t>(header.size);
    }
    return {};
}

}  // namespace skyloop
