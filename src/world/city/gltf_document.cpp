#include "detail/gltf_document.hpp"

#include <fmt/format.h>

#include <array>
#include <limits>
#include <type_traits>

#include "base/core/archive.hpp"
#include "detail/city_text.hpp"
#include "detail/json_text.hpp"

namespace skyloop::inline world {
namespace {

std::uint32_t little_word(std::string_view bytes, std::size_t at) {
    std::uint32_t value = 0;
    for (std::size_t i = 4; i-- > 0;)
        value = value << 8 | static_cast<unsigned char>(bytes[at + i]);
    return value;
}

template <class T>
constexpr GltfComponent component(std::uint64_t type) {
    return {type, sizeof(T), number_at<T>,
            std::is_integral_v<T> ? static_cast<double>(std::numeric_limits<T>::max()) : 0};
}

std::optional<GltfComponent> component_of_type(std::uint64_t type) {
    constexpr std::array known{component<std::int8_t>(5120),   component<std::uint8_t>(5121),
                               component<std::int16_t>(5122),  component<std::uint16_t>(5123),
                               component<std::uint32_t>(5125), component<float>(gltf_float)};
    for (const GltfComponent& one : known)
        if (one.type == type) return one;
    return std::nullopt;
}

// RFC 4648 section 4; nothing when it holds other characters.
std::optional<std::string> from_base64(std::string_view text) {
    std::string bytes;
    bytes.reserve(text.size() / 4 * 3 + 3);
    std::uint32_t bits = 0;
    int have = 0;
    while (text.ends_with('='))
        text.remove_suffix(1);
    for (const char c : text) {
        const int value = c >= 'A' && c <= 'Z'   ? c - 'A'
                          : c >= 'a' && c <= 'z' ? c - 'a' + 26
                          : c >= '0' && c <= '9' ? c - '0' + 52
                          : c == '+'             ? 62
                          : c == '/'             ? 63
                                                 : -1;
        if (value < 0) return std::nullopt;
        bits = (bits << 6 | static_cast<std::uint32_t>(value)) & 0xFFFFFFU;
        have += 6;
        if (have < 8) continue;
        have -= 8;
        bytes.push_back(static_cast<char>(bits >> have & 0xFFU));
    }
    return bytes;
}

// "%20" and its kin.
std::string from_percent(std::string_view uri) {
    std::string plain;
    const auto digit = [](char c) {
        return c >= '0' && c <= '9'   ? c - '0'
               : c >= 'a' && c <= 'f' ? c - 'a' + 10
               : c >= 'A' && c <= 'F' ? c - 'A' + 10
                                      : -1;
    };
    for (std::size_t i = 0; i < uri.size(); ++i) {
        const bool coded = uri[i] == '%' && i + 2 < uri.size() && digit(uri[i + 1]) >= 0 && digit(uri[i + 2]) >= 0;
        plain.push_back(coded ? static_cast<char>(digit(uri[i + 1]) * 16 + digit(uri[i + 2])) : uri[i]);
        if (coded) i += 2;
    }
    return plain;
}

// Extensions that leave the shapes as they are without it, or that are read.
bool leaves_shapes(std::string_view extension) {
    for (const char* harmless : {"KHR_materials", "KHR_texture", "KHR_lights", "KHR_mesh_quantization", "EXT_texture"})
        if (extension.starts_with(harmless)) return true;
    return false;
}

}  // namespace

std::optional<std::uint64_t> gltf_index(const JsonData& object, const char* key) {
    const JsonData& found = member(object, key);
    return found.is_number_unsigned() ? std::optional(found.get<std::uint64_t>()) : std::nullopt;
}

std::vector<double> gltf_numbers(const JsonData& object, const char* key, std::vector<double> otherwise) {
    const auto found = object.is_object() ? object.find(key) : object.end();
    if (found == object.end()) return otherwise;
    std::vector<double> numbers;
    if (!found->is_array() || found->size() > 16) return numbers;
    for (const JsonData& number : *found) {
        if (!number.is_number()) return {};
        numbers.push_back(number.get<double>());
    }
    return numbers;
}

double GltfNumbers::number(std::size_t index, unsigned which) const {
    const double value = component.read(bytes.data() + index * stride + which * component.size);
    return normalized && component.most > 0 ? std::max(-1.0, value / component.most) : value;
}

tl::unexpected<Error> GltfDocument::wrong(std::string_view what) const {
    return fail(ErrorCode::input, fmt::format("{}: {}", name_, what));
}

Result<GltfDocument> GltfDocument::parse(std::string_view bytes, std::string_view name,
                                         const CompanionFiles& companions, std::size_t most_bytes) {
    GltfDocument document;
    document.most_bytes_ = most_bytes;
    document.name_ = name;
    document.companions_ = companions;
    if (auto done = document.take_chunks(bytes); !done) return fail(std::move(done.error()));
    if (auto done = document.check_version(); !done) return fail(std::move(done.error()));
    document.loaded_.resize(document.list("buffers").size());
    return document;
}

// Section 4.4: a header of 12 bytes, a chunk of JSON, and one of bytes.
Result<void> GltfDocument::take_chunks(std::string_view bytes) {
    std::string_view text = bytes;
    std::size_t before = 0;
    if (bytes.starts_with("glTF")) {
        if (bytes.size() < 20 || little_word(bytes, 16) != 0x4E4F534A)
            return wrong("byte 12: expected a chunk of JSON");
        if (little_word(bytes, 4) != 2) return wrong(fmt::format("glTF version {}; expected 2", little_word(bytes, 4)));
        if (little_word(bytes, 8) > bytes.size())
            return wrong(fmt::format("byte 8: tells of {} bytes, but has {}", little_word(bytes, 8), bytes.size()));
        const std::size_t length = little_word(bytes, 12);
        before = 20;
        if (length > bytes.size() - before)
            return wrong(fmt::format("byte 12: a chunk of {} bytes, but {} are left", length, bytes.size() - before));
        text = bytes.substr(before, length);
        std::size_t at = before + (length + 3) / 4 * 4;
        if (at + 8 <= bytes.size() && little_word(bytes, at + 4) == 0x004E4942) {
            const std::size_t size = little_word(bytes, at);
            at += 8;
            if (size > bytes.size() - at)
                return wrong(
                    fmt::format("byte {}: a chunk of {} bytes, but {} are left", at - 8, size, bytes.size() - at));
            binary_ = bytes.substr(at, size);
        }
    }
    try {
        root_ = JsonData::parse(text);
    } catch (const JsonData::parse_error& error) {
        const std::size_t at = error.byte > 0 ? error.byte - 1 : 0;
        return wrong(before > 0 ? fmt::format("byte {}: is no JSON", before + at)
                                : fmt::format("line {}: is no JSON", line_place("", text, at).substr(1)));
    } catch (const JsonData::exception&) {
        return wrong("its JSON holds a number beyond all bounds");
    }
    return {};
}

Result<void> GltfDocument::check_version() const {
    const std::string_view version = text_member(member(root_, "asset"), "version");
    if (!version.starts_with("2."))
        return wrong(version.empty() ? "has no asset with a version of glTF"
                                     : fmt::format("glTF version {}; expected 2", shown(version)));
    for (const JsonData& extension : list("extensionsRequired"))
        if (!extension.is_string() || !leaves_shapes(extension.get_ref<const std::string&>()))
            return wrong(fmt::format("needs the extension {}, which is not read",
                                     extension.is_string() ? shown(extension.get_ref<const std::string&>()) : "?"));
    return {};
}

const JsonData& GltfDocument::list(const char* key) const {
    static const JsonData none = JsonData::array();
    const JsonData& found = member(root_, key);
    return found.is_array() ? found : none;
}

Result<std::string> GltfDocument::load(const JsonData& buffer) {
    const std::string_view uri = text_member(buffer, "uri");
    if (uri.starts_with("data:")) {
        const std::size_t comma = uri.find(";base64,");
        auto bytes = comma == uri.npos ? std::nullopt : from_base64(uri.substr(comma + 8));
        if (!bytes) return wrong("a buffer's data URI is no base64");
        return std::move(*bytes);
    }
    const auto inside = name_inside(from_percent(uri));
    if (!inside)
        return wrong(
            fmt::format("a buffer names the file '{}'; expected one inside the folder of the file", shown(uri)));
    auto bytes = companions_(*inside);
    if (!bytes) return wrong(bytes.error().message);
    return bytes;
}

Result<std::string_view> GltfDocument::buffer(std::uint64_t index) {
    const JsonData& buffers = list("buffers");
    if (index >= buffers.size()) return wrong(fmt::format("names buffer {} of {}", index, buffers.size()));
    const JsonData& told = buffers[index];
    const auto length = gltf_index(told, "byteLength");
    if (!length) return wrong(fmt::format("buffer {} has no byteLength", index));
    std::string_view bytes;
    if (!told.contains("uri")) {
        if (index != 0 || !binary_) return wrong(fmt::format("buffer {} has no uri", index));
        bytes = *binary_;
    } else {
        if (!loaded_[index]) {
            auto loaded = load(told);
            if (!loaded) return fail(std::move(loaded.error()));
            loaded_bytes_ += loaded->size();
            if (loaded_bytes_ > most_bytes_)
                return wrong(fmt::format("has more than {} bytes of buffers, the most that is read", most_bytes_));
            loaded_[index] = std::move(*loaded);
        }
        bytes = *loaded_[index];
    }
    if (*length > bytes.size())
        return wrong(fmt::format("buffer {} tells of {} bytes, but has {}", index, *length, bytes.size()));
    return bytes.substr(0, *length);
}

Result<GltfNumbers> GltfDocument::numbers(std::uint64_t accessor, std::string_view type) {
    const JsonData& accessors = list("accessors");
    if (accessor >= accessors.size()) return wrong(fmt::format("names accessor {} of {}", accessor, accessors.size()));
    const JsonData& told = accessors[accessor];
    const auto view_index = gltf_index(told, "bufferView"), count = gltf_index(told, "count");
    const auto component = component_of_type(gltf_index(told, "componentType").value_or(0));
    const JsonData& views = list("bufferViews");
    if (told.contains("sparse")) return wrong(fmt::format("accessor {} is sparse, which is not read", accessor));
    if (!count || !view_index || *view_index >= views.size() || text_member(told, "type") != type || !component)
        return wrong(
            fmt::format("accessor {}: expected a bufferView, a count, type {} and a componentType", accessor, type));
    const JsonData& view = views[*view_index];
    const auto buffer_index = gltf_index(view, "buffer");
    if (!buffer_index) return wrong(fmt::format("bufferView {} names no buffer", *view_index));
    const auto bytes = buffer(*buffer_index);
    if (!bytes) return fail(bytes.error());
    const std::uint64_t view_offset = gltf_index(view, "byteOffset").value_or(0);
    const std::uint64_t view_length = gltf_index(view, "byteLength").value_or(0);
    if (view_offset > bytes->size() || view_length > bytes->size() - view_offset)
        return wrong(fmt::format("bufferView {}: {} bytes from {}, but its buffer has {}", *view_index, view_length,
                                 view_offset, bytes->size()));
    GltfNumbers numbers;
    numbers.component = *component;
    numbers.components = type == "VEC3" ? 3 : 1;
    numbers.normalized = told.value("normalized", JsonData()) == JsonData(true);
    const std::uint64_t size = std::uint64_t{component->size} * numbers.components;
    const std::uint64_t stride = gltf_index(view, "byteStride").value_or(size);
    const std::uint64_t offset = gltf_index(told, "byteOffset").value_or(0);
    // One each needs a byte at least: so the product below cannot overflow.
    if (stride < size || stride > 65'536 || *count > view_length || offset > view_length ||
        (*count > 0 && stride * (*count - 1) + size > view_length - offset))
        return wrong(fmt::format("accessor {}: {} of {} bytes from {}, but its bufferView has {}", accessor, *count,
                                 stride, offset, view_length));
    numbers.bytes = bytes->substr(view_offset + offset);
    numbers.count = *count;
    numbers.stride = stride;
    return numbers;
}

}  // namespace skyloop::inline world
