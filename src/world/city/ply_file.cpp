#include <fmt/format.h>

#include <array>
#include <bit>
#include <charconv>
#include <cmath>
#include <type_traits>
#include <utility>

#include "detail/city_text.hpp"
#include "detail/ply_file.hpp"

namespace skyloop::inline world {
namespace {

template <class T>
constexpr PlyType type_of{sizeof(T), std::is_integral_v<T>, number_at<T>};

std::optional<PlyType> ply_type(std::string_view word) {
    constexpr std::array<std::pair<std::string_view, PlyType>, 16> types{{{"char", type_of<std::int8_t>},
                                                                          {"uchar", type_of<std::uint8_t>},
                                                                          {"short", type_of<std::int16_t>},
                                                                          {"ushort", type_of<std::uint16_t>},
                                                                          {"int", type_of<std::int32_t>},
                                                                          {"uint", type_of<std::uint32_t>},
                                                                          {"float", type_of<float>},
                                                                          {"double", type_of<double>},
                                                                          {"int8", type_of<std::int8_t>},
                                                                          {"uint8", type_of<std::uint8_t>},
                                                                          {"int16", type_of<std::int16_t>},
                                                                          {"uint16", type_of<std::uint16_t>},
                                                                          {"int32", type_of<std::int32_t>},
                                                                          {"uint32", type_of<std::uint32_t>},
                                                                          {"float32", type_of<float>},
                                                                          {"float64", type_of<double>}}};
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

namespace {

double binary_number(const char* at, const PlyType& type, bool turned) {
    std::array<unsigned char, 8> bytes{};
    for (unsigned i = 0; i < type.size; ++i)
        bytes[turned ? type.size - 1 - i : i] = static_cast<unsigned char>(at[i]);
    return type.number(bytes.data());
}

class PlyBody {
public:
    PlyBody(MeshBuilder& builder, std::string_view bytes, std::string_view name, const PlyHeader& header)
        : builder_(builder),
          bytes_(bytes),
          name_(name),
          encoding_(header.encoding),
          turned_((std::endian::native == std::endian::big) == (header.encoding == PlyEncoding::little_endian)),
          at_(header.size) {}

    Result<void> read(const PlyElement& element, MeshPart part) {
        const std::uint64_t each = element.least_size(encoding_), left = bytes_.size() - at_;
        // The last number of a text needs no blank behind it.
        if (element.count > 0 && (each == 0 || element.count > (left + 1) / each))
            return fail(ErrorCode::input,
                        fmt::format("{}: tells of {} elements '{}' of at least {} bytes, but {} bytes are left", name_,
                                    element.count, shown(element.name), each, left));
        if (element.name == "vertex") return vertices(element);
        if (element.name == "face") return faces(element, part);
        if (element.name == "tristrips" && element.count > 0)
            return fail(ErrorCode::input, fmt::format("{}: holds triangle strips, which are not read", name_));
        return other(element);
    }

private:
    [[nodiscard]] std::string here() const {
        return encoding_ == PlyEncoding::ascii ? line_place(name_, bytes_, at_)
                                               : fmt::format("{}: byte {}", name_, at_);
    }
    tl::unexpected<Error> no_number(const PlyElement& element, std::uint64_t index) const {
        const bool over = at_ >= bytes_.size() || encoding_ != PlyEncoding::ascii;
        const std::size_t end = std::min(bytes_.find_first_of(" \t\r\n", at_), bytes_.size());
        return fail(ErrorCode::input,
                    over ? fmt::format("{}: ends in {} {} of {}", here(), shown(element.name), index, element.count)
                         : fmt::format("{}: expected a number of {} {}, found '{}'", here(), shown(element.name), index,
                                       shown(bytes_.substr(at_, end - at_))));
    }

    std::optional<double> number(const PlyType& type) {
        if (encoding_ != PlyEncoding::ascii) {
            if (bytes_.size() - at_ < type.size) return std::nullopt;
            const double value = binary_number(bytes_.data() + at_, type, turned_);
            at_ += type.size;
            return value;
        }
        at_ = std::min(bytes_.find_first_not_of(" \t\r\n", at_), bytes_.size());
        const char *first = bytes_.data() + at_, *end = bytes_.data() + bytes_.size();
        const char* after = first;
        const auto value = take_number(after, end);
        if (!value || !(after == end || *after == ' ' || *after == '\t' || *after == '\r' || *after == '\n'))
            return std::nullopt;
        at_ += static_cast<std::size_t>(after - first);
        return value;
    }

    // One property into list_: a list's items, or the number alone.
    Result<void> property(const PlyElement& element, const PlyProperty& property, std::uint64_t index) {
        list_.clear();
        std::uint64_t count = 1;
        if (property.count_type) {
            const auto told = number(*property.count_type);
            if (!told) return no_number(element, index);
            const std::uint64_t least = encoding_ == PlyEncoding::ascii ? 2 : property.type.size;
            const std::uint64_t fitting = (bytes_.size() - at_ + 1) / least;
            const auto most = static_cast<double>(fitting);
            if (!(*told >= 0 && *told <= most && *told == std::floor(*told)))
                return fail(ErrorCode::input,
                            fmt::format("{}: a list of {} items in {} {}, but {} bytes are left", here(), *told,
                                        shown(element.name), index, bytes_.size() - at_));
            count = static_cast<std::uint64_t>(*told);
        }
        for (std::uint64_t i = 0; i < count; ++i) {
            const auto value = number(property.type);
            if (!value) return no_number(element, index);
            list_.push_back(*value);
        }
        return {};
    }

    Result<void> vertices(const PlyElement& element) {
        if (element.count == 0) return {};
        if (!builder_.may_add(element.count, 0)) return builder_.too_many();
        unsigned seen = 0;
        for (const PlyProperty& each : element.properties)
            if (!each.count_type && each.name.size() == 1 && each.name[0] >= 'x' && each.name[0] <= 'z')
                seen |= 1U << (each.name[0] - 'x');
        if (seen != 7) return fail(ErrorCode::input, fmt::format("{}: its vertices have no x, y and z", name_));
        builder_.reserve(element.count, 0);
        for (std::uint64_t i = 0; i < element.count; ++i) {
            Eigen::Vector3d place = Eigen::Vector3d::Zero();
            for (const PlyProperty& each : element.properties) {
                if (auto done = property(element, each, i); !done) return done;
                if (!each.count_type && each.name.size() == 1 && each.name[0] >= 'x' && each.name[0] <= 'z')
                    place[each.name[0] - 'x'] = list_.front();
            }
            if (!builder_.add_vertex(place)) return builder_.too_many();
        }
        return {};
    }

    Result<void> faces(const PlyElement& element, MeshPart part) {
        if (!builder_.may_add(0, element.count)) return builder_.too_many();
        bool told = element.count == 0;
        for (const PlyProperty& each : element.properties)
            told = told || names_corners(each);
        if (!told) return fail(ErrorCode::input, fmt::format("{}: its faces have no list vertex_indices", name_));
        builder_.reserve(0, element.count);
        for (std::uint64_t i = 0; i < element.count; ++i) {
            for (const PlyProperty& each : element.properties) {
                if (auto done = property(element, each, i); !done) return done;
                if (!names_corners(each)) continue;
                if (auto done = face(i, part); !done) return done;
            }
        }
        return {};
    }
    static bool names_corners(const PlyProperty& property) {
        return property.count_type && (property.name == "vertex_indices" || property.name == "vertex_index");
    }
    Result<void> face(std::uint64_t index, MeshPart part) {
        corners_.clear();
        const auto count = static_cast<double>(builder_.vertices());
        for (const double corner : list_) {
            if (!(corner >= 0 && corner < count && corner == std::floor(corner)))
                return fail(ErrorCode::input, fmt::format("{}: face {} names vertex {}, of {} (the first is 0)", here(),
                                                          index, corner, count));
            corners_.push_back(static_cast<std::uint32_t>(corner));
        }
        if (!builder_.add_polygon(corners_, part)) return builder_.too_many();
        return {};
    }

    Result<void> other(const PlyElement& element) {
        for (std::uint64_t i = 0; i < element.count; ++i)
            for (const PlyProperty& each : element.properties)
                if (auto done = property(element, each, i); !done) return done;
        return {};
    }

    MeshBuilder& builder_;
    std::string_view bytes_, name_;
    PlyEncoding encoding_;
    bool turned_;
    std::size_t at_;
    std::vector<double> list_;
    std::vector<std::uint32_t> corners_;
};

}  // namespace

Result<void> add_ply(MeshBuilder& builder, std::string_view bytes, std::string_view name, MeshPart part) {
    bytes = without_byte_order_mark(bytes);
    const auto header = parse_ply_header(bytes, name);
    if (!header) return fail(header.error());
    PlyBody body(builder, bytes, name, *header);
    for (const PlyElement& element : header->elements)
        if (auto done = body.read(element, part); !done) return done;
    return {};
}

Result<CityFile> parse_ply(std::string_view bytes, std::string_view name, const CityFileSettings& settings) {
    MeshBuilder builder(settings, name, "x,y,z");
    builder.begin_mesh();
    if (auto done = add_ply(builder, bytes, name, {}); !done) return fail(std::move(done.error()));
    return builder.finish("ply");
}

}  // namespace skyloop::inline world
