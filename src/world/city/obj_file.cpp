#include <fmt/format.h>

#include <array>
#include <charconv>
#include <cstring>

#include "detail/city_text.hpp"
#include "detail/mesh_builder.hpp"

namespace skyloop::inline world {
namespace {

bool is_blank(char c) { return c == ' ' || c == '\t' || c == '\r'; }

// Lines that begin with a letter and a blank: an upper bound of vertices or, for 'f', of faces.
std::size_t lines_of(std::string_view text, char letter) {
    std::size_t count = 0;
    for (std::size_t at = 0; at + 1 < text.size();) {
        if (text[at] == letter && is_blank(text[at + 1])) ++count;
        const void* end = std::memchr(text.data() + at, '\n', text.size() - at);
        if (!end) break;
        at = static_cast<std::size_t>(static_cast<const char*>(end) - text.data()) + 1;
    }
    return count;
}

// Statements of the format that say nothing about facets.
bool is_of_no_facets(std::string_view keyword) {
    constexpr std::array<std::string_view, 18> words{"vn",     "vt",     "vp",         "s",         "l",        "p",
                                                     "mtllib", "mg",     "bevel",      "c_interp",  "d_interp", "lod",
                                                     "maplib", "usemap", "shadow_obj", "trace_obj", "call",     "csh"};
    for (const std::string_view word : words)
        if (word == keyword) return true;
    return false;
}

// One pass over the text; each statement is read where it stands.
class ObjReader {
public:
    ObjReader(std::string_view text, std::string_view name, const CityFileSettings& settings)
        : text_(text), name_(name), builder_(settings, name, "x,y,z"), at_(text.data()), end_(at_ + text.size()) {}

    Result<CityFile> read() {
        const std::size_t faces = lines_of(text_, 'f'), vertices = lines_of(text_, 'v');
        if (!builder_.may_add(vertices, faces)) return builder_.too_many();
        builder_.reserve(vertices, faces);
        while (at_ != end_) {
            if (auto done = statement(); !done) return fail(std::move(done.error()));
            to_next_line();
        }
        if (unread_ > 0)
            builder_.warn(fmt::format("{}: {} statements are of no known kind, the first is '{}'", first_unread_place_,
                                      unread_, first_unread_));
        return builder_.finish("obj");
    }

private:
    // A backslash at the end of a line continues it.
    void skip_blanks() {
        for (; at_ != end_; ++at_) {
            if (is_blank(*at_)) continue;
            if (*at_ != '\\') return;
            const char* behind = at_ + 1;
            if (behind != end_ && *behind == '\r') ++behind;
            if (behind == end_ || *behind != '\n') return;
            at_ = behind;
        }
    }
    [[nodiscard]] bool at_line_end() const { return at_ == end_ || *at_ == '\n' || *at_ == '#'; }
    void to_next_line() {
        const void* newline = at_ == end_ ? nullptr : std::memchr(at_, '\n', static_cast<std::size_t>(end_ - at_));
        at_ = newline ? static_cast<const char*>(newline) + 1 : end_;
    }
    std::string_view word() {
        const char* first = at_;
        while (at_ != end_ && !is_blank(*at_) && *at_ != '\n')
            ++at_;
        return {first, static_cast<std::size_t>(at_ - first)};
    }
    // What stands until the end of the line, without blanks around it.
    std::string_view rest_of_line() {
        skip_blanks();
        const char* first = at_;
        while (at_ != end_ && *at_ != '\n')
            ++at_;
        std::string_view rest(first, static_cast<std::size_t>(at_ - first));
        while (!rest.empty() && is_blank(rest.back()))
            rest.remove_suffix(1);
        return rest;
    }
    [[nodiscard]] std::string here() const {
        return line_place(name_, text_, static_cast<std::size_t>(at_ - text_.data()));
    }

    Result<void> statement() {
        skip_blanks();
        if (at_line_end()) return {};
        const std::string_view keyword = word();
        if (keyword == "v") return vertex();
        if (keyword == "f" || keyword == "fo") return face();
        if (keyword == "o" || keyword == "g" || keyword == "usemtl") {
            std::string_view& known = keyword == "o" ? object_ : keyword == "g" ? group_ : material_;
            known = rest_of_line();
            part_ = builder_.part(material_, std::array{object_, group_});
        } else if (!is_of_no_facets(keyword) && unread_++ == 0) {
            first_unread_ = shown(keyword);
            first_unread_place_ = here();
        }
        return {};
    }

    Result<void> vertex() {
        Eigen::Vector3d place;
        for (Eigen::Index i = 0; i < 3; ++i) {
            skip_blanks();
            const auto number = take_number(at_, end_);
            if (!number || !(at_line_end() || is_blank(*at_)))
                return fail(ErrorCode::input, fmt::format("{}: expected x, y and z of a vertex, found '{}' as {}",
                                                          here(), shown(word()), "xyz"[i]));
            place[i] = *number;
        }
        if (!builder_.add_vertex(place)) return builder_.too_many();
        return {};
    }

    Result<void> face() {
        corners_.clear();
        for (skip_blanks(); !at_line_end(); skip_blanks()) {
            const char* first = at_;
            long long number = 0;
            const auto [after, error] = std::from_chars(at_, end_, number);
            if (error != std::errc{} || !(after == end_ || *after == '/' || *after == '\n' || is_blank(*after)))
                return fail(ErrorCode::input,
                            fmt::format("{}: expected the number of a vertex, found '{}'", here(), shown(word())));
            at_ = after;
            word();  // numbers of texture and normal
            const auto count = static_cast<long long>(builder_.vertices());
            const long long index = number > 0 ? number - 1 : number < 0 ? count + number : -1;
            if (index < 0 || index >= count) {
                at_ = first;
                return fail(ErrorCode::input,
                            fmt::format("{}: a face names vertex {}, of {} until there", here(), number, count));
            }
            corners_.push_back(static_cast<std::uint32_t>(index));
        }
        if (corners_.size() < 3)
            return fail(ErrorCode::input,
                        fmt::format("{}: a face with {} corners; expected 3 or more", here(), corners_.size()));
        if (!builder_.add_polygon(corners_, part_)) return builder_.too_many();
        return {};
    }

    std::string_view text_, name_;
    MeshBuilder builder_;
    const char* at_;
    const char* end_;
    std::string_view object_, group_, material_;
    MeshPart part_;
    std::vector<std::uint32_t> corners_;
    std::size_t unread_ = 0;
    std::string first_unread_, first_unread_place_;
};

}  // namespace

Result<CityFile> parse_obj(std::string_view text, std::string_view name, const CityFileSettings& settings) {
    return ObjReader(without_byte_order_mark(text), name, settings).read();
}

}  // namespace skyloop::inline world
