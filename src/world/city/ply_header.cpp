#include <fmt/format.h>

#include <array>
#include <charconv>
#include <utility>

#include "detail/city_text.hpp"
#include "detail/ply_file.hpp"

namespace skyloop {
namespace {

std::optional<PlyType> ply_type(std::string_view word) {
    constexpr std::array<std::pair<std::string_view, PlyType>, 16> types{{{"char", {1, true, true}},
                                                                          {"uchar", {1, true, false}},
                                                                          {"short", {2, true, true}},
                                                                          {"ushort", {2, true, false}},
                                                                          {"int", {4, true, true}},
                                                                          {"uint", {4, true, false}},
                                                                          {"float", {4, false, true}},
                                                                          {"double", {8, false, true}},
                                                                          {"int8", {1, true, true}},
                                                                          {"uint8", {1, true, false}},
                                                                          {"int16", {2, true, true}},
                                                                          {"uint16", {2, true, false}},
                                                                          {"int32", {4, true, true}},
                                                                          {"uint32", {4, true, false}},
                                                                          {"float32", {4, false, true}},
                                                                          {"float64", {8, false, true}}}};
    for (const auto& [name, type] : types)
        if (name == word) return type;
    return std::nullopt;
}

std::vector<std::string_view> words_of(std::string_view line) {
    std::vector<std::string_view> words;
    for (std::size_t at = line.find_first_not_of(" \t\r"); at != std::string_view::npos;) {
        const std::size_t end = std::min(line.find_first_of(" \t\r", at), line.size());
        words.push_back(line.substr(at, end - at));
        at = line.find_first_not_of(" \t\r", end);
    }
    return words;
}

// What a line of the header says, or what is wrong with it.
std::string take_line(PlyHeader& header, bool& formatted, const std::vector<std::string_view>& words) {
    const std::string_view keyword = words.front();
    if (keyword == "comment" || keyword == "obj_info") return "";
    if (keyword == "format") {
        constexpr std::array<std::string_view, 3> names{"ascii", "binary_little_endian", "binary_big_endian"};
        for (std::size_t i = 0; i < names.size(); ++i) {
            if (words.size() != 3 || words[1] != names[i] || words[2] != "1.0") continue;
            header.encoding = static_cast<PlyEncoding>(i);
            formatted = true;
            return "";
        }
        return "expected 'format ascii 1.0', 'binary_little_endian 1.0' or 'binary_big_endian 1.0'";
    }
    if (keyword == "element") {
        PlyElement element;
        if (words.size() != 3) return "expected 'element NAME COUNT'";
        const auto [after, error] = std::from_chars(words[2].data(), words[2].data() + words[2].size(), element.count);
        if (error != std::errc{} || after != words[2].data() + words[2].size())
            return fmt::format("expected a count of elements, found '{}'", shown(words[2]));
        element.name = words[1];
        header.elements.push_back(std::move(element));
        return "";
    }
    if (keyword != "property") return fmt::format("'{}' is no keyword of a PLY header", shown(keyword));
    if (header.elements.empty()) return "a property stands before the first element";
    const bool list = words.size() == 5 && words[1] == "list";
    if (!list && words.size() != 3) return "expected 'property TYPE NAME' or 'property list TYPE TYPE NAME'";
    PlyProperty property;
    const auto type = ply_type(words[list ? 3 : 1]);
    if (list) property.count_type = ply_type(words[2]);
    if (!type || (list && !(property.count_type && property.count_type->integer)))
        return "expected types such as uchar, int or float, and a whole one for the count of a list";
    property.type = *type;
    property.name = words.back();
    header.elements.back().properties.push_back(std::move(property));
    return "";
}

}  // namespace

std::uint64_t PlyElement::least_size(PlyEncoding encoding) const {
    std::uint64_t size = 0;
    for (const PlyProperty& property : properties)
        size += encoding == PlyEncoding::ascii ? 2
                : property.count_type          ? property.count_type->size
                                               : property.type.size;
    return size;
}

Result<PlyHeader> parse_ply_header(std::string_view bytes, std::string_view name) {
    PlyHeader header;
    bool formatted = false;
    for (std::size_t at = 0, line = 1; at < bytes.size(); ++line) {
        const std::size_t end = bytes.find('\n', at);
        if (end == std::string_view::npos) break;
        const std::vector<std::string_view> words = words_of(bytes.substr(at, end - at));
        at = end + 1;
        if (line == 1) {
            if (words.size() == 1 && words[0] == "ply") continue;
            return fail(ErrorCode::input, fmt::format("{}:1: is no PLY file; expected 'ply'", name));
        }
        if (words.empty()) continue;
        if (words[0] == "end_header") {
            if (!formatted) return fail(ErrorCode::input, fmt::format("{}:{}: no format is given", name, line));
            header.size = at;
            return header;
        }
        const std::string wrong = take_line(header, formatted, words);
        if (!wrong.empty()) return fail(ErrorCode::input, fmt::format("{}:{}: {}", name, line, wrong));
    }
    return fail(ErrorCode::input, fmt::format("{}: ends before 'end_header' of a PLY file", name));
}

}  // namespace skyloop
