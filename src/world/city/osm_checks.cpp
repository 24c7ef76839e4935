#include <fmt/format.h>
#include <protozero/pbf_reader.hpp>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <cstdint>
#include <exception>
#include <string>

#include "detail/city_text.hpp"
#include "detail/osm_checks.hpp"

namespace skyloop::inline world {
namespace {

/// Behind the comment that begins at `at`.
std::size_t comment_end(std::string_view xml, std::size_t at) {
    const std::size_t end = xml.find("-->", at);
    return end == std::string_view::npos ? xml.size() : end + 3;
}

/// Behind the element's head that begins at `at`; a '>' between quotes does not end it.
std::size_t head_end(std::string_view xml, std::size_t at) {
    for (at = xml.find_first_of("'\">", at); at != std::string_view::npos; at = xml.find_first_of("'\">", at + 1)) {
        if (xml[at] == '>') return at + 1;
        at = xml.find(xml[at], at + 1);
        if (at == std::string_view::npos) break;
    }
    return xml.size();
}

/// Takes the next attribute off the front of an element's inside. @returns false when there is none
bool take_attribute(std::string_view& rest, std::string_view& name, std::string_view& value) {
    const std::size_t equals = rest.find('=');
    if (equals == std::string_view::npos) return false;
    const std::size_t open = rest.find_first_of("'\"", equals);
    if (open == std::string_view::npos) return false;
    const std::size_t close = rest.find(rest[open], open + 1);
    if (close == std::string_view::npos) return false;
    name = rest.substr(0, equals);
    name.remove_prefix(std::min(name.find_first_not_of(" \t\r\n"), name.size()));
    name = name.substr(0, name.find_first_of(" \t\r\n"));
    value = rest.substr(open + 1, close - open - 1);
    rest.remove_prefix(close + 1);
    return true;
}

/// The number of an element that is marked, by its attributes.
bool is_marked_deleted(std::string_view attributes, std::int64_t& id) {
    bool deleted = false, numbered = false;
    for (std::string_view name, value; take_attribute(attributes, name, value);) {
        if (name == "action") deleted = value == "delete";
        if (name == "id") numbered = std::from_chars(value.data(), value.data() + value.size(), id).ec == std::errc();
    }
    return deleted && numbered;
}

/// Tells `use` of the type of each element and what stands behind it in its head, until it returns false.
template <class Use>
void for_each_element(std::string_view xml, const Use& use) {
    for (std::size_t at = xml.find('<'); at < xml.size(); at = xml.find('<', at)) {
        if (xml.substr(at).starts_with("<!--")) {
            at = comment_end(xml, at);
            continue;
        }
        const std::size_t end = head_end(xml, at);
        const std::string_view head = xml.substr(at + 1, end - at - 1);
        at = end;
        const std::string_view type = head.substr(0, head.find_first_of(" \t\r\n"));
        if (!use(type, head.substr(type.size()))) return;
    }
}

bool is_wild(std::string_view coordinate) {
    constexpr double beyond_all = 1000;  // degrees
    const std::size_t exponent = coordinate.find_first_of("eE&");
    if (exponent == std::string_view::npos) return false;
    if (coordinate[exponent] == '&') return true;  // nobody writes digits so
    const char* at = coordinate.data();
    return std::abs(take_number(at, at + coordinate.size()).value_or(0)) > beyond_all;
}

}  // namespace

OsmDeletions osm_deletions(std::string_view xml) {
    OsmDeletions deletions;
    if (xml.find("action") == std::string_view::npos) return deletions;
    for_each_element(xml, [&](std::string_view type, std::string_view attributes) {
        std::set<std::int64_t>* ids = type == "node"       ? &deletions.nodes
                                      : type == "way"      ? &deletions.ways
                                      : type == "relation" ? &deletions.relations
                                                           : nullptr;
        std::int64_t id = 0;
        if (ids && is_marked_deleted(attributes, id)) ids->insert(id);
        return true;
    });
    return deletions;
}

std::optional<std::string_view> wild_coordinate(std::string_view xml) {
    std::optional<std::string_view> found;
    for_each_element(xml, [&](std::string_view type, std::string_view attributes) {
        if (type == "tag") return true;
        // Of nodes, of the nodes of ways, and those of bounds, such as maxlat.
        for (std::string_view name, value; !found && take_attribute(attributes, name, value);)
            if ((name.ends_with("lat") || name.ends_with("lon")) && is_wild(value)) found = value;
        return !found;
    });
    return found;
}

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

}  // namespace skyloop::inline world
