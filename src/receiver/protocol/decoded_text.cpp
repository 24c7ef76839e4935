#include <fmt/format.h>

#include <cmath>
#include <iterator>

#include "base/core/letter_case.hpp"
#include "receiver/protocol/decoded_message.hpp"

namespace skyloop {
namespace {

std::string hex_of(ByteSpan bytes) {
    std::string text;
    text.reserve(2 * bytes.size());
    for (const std::uint8_t byte : bytes)
        fmt::format_to(std::back_inserter(text), "{:02x}", byte);
    return text;
}

std::string json_number(double value) {
    if (!std::isfinite(value)) return "null";
    // JSON has no "-0"; and what is whole is written as whole.
    if (value == 0) return "0";
    return fmt::format("{}", value);
}

std::string json_fields(const std::vector<DecodedField>& fields);

std::string json_list(const std::vector<DecodedValue>& values);

struct JsonValue {
    std::string operator()(std::monostate) const { return "null"; }
    std::string operator()(std::int64_t value) const { return fmt::format("{}", value); }
    std::string operator()(std::uint64_t value) const { return fmt::format("{}", value); }
    std::string operator()(double value) const { return json_number(value); }
    std::string operator()(const std::string& value) const { return json_string(value); }
    std::string operator()(const std::vector<DecodedValue>& values) const { return json_list(values); }
    std::string operator()(const std::vector<DecodedField>& fields) const { return json_fields(fields); }
};

std::string json_list(const std::vector<DecodedValue>& values) {
    std::string text = "[";
    for (const DecodedValue& value : values) {
        if (text.size() > 1) text += ',';
        text += std::visit(JsonValue{}, value.content);
    }
    return text + ']';
}

std::string json_fields(const std::vector<DecodedField>& fields) {
    std::string text = "{";
    for (const DecodedField& field : fields) {
        if (text.size() > 1) text += ',';
        text += json_string(field.name) + ':' + std::visit(JsonValue{}, field.value.content);
    }
    return text + '}';
}

std::string text_fields(const std::vector<DecodedField>& fields);

// Quoted where it could be taken for something else.
std::string text_word(const std::string& word) {
    for (const char c : word)
        if (c <= ' ' || c > '~' || c == '"' || c == '=' || c == '[' || c == '{') return json_string(word);
    return word.empty() ? "\"\"" : word;
}

struct TextValue {
    std::string operator()(std::monostate) const { return "-"; }
    std::string operator()(std::int64_t value) const { return fmt::format("{}", value); }
    std::string operator()(std::uint64_t value) const { return fmt::format("{}", value); }
    std::string operator()(double value) const { return std::isfinite(value) ? json_number(value) : "-"; }
    std::string operator()(const std::string& value) const { return text_word(value); }
    std::string operator()(const std::vector<DecodedValue>& values) const {
        std::string text = "[";
        for (const DecodedValue& value : values) {
            if (text.size() > 1) text += ' ';
            text += std::visit(*this, value.content);
        }
        return text + ']';
    }
    std::string operator()(const std::vector<DecodedField>& fields) const { return '{' + text_fields(fields) + '}'; }
};

std::string text_fields(const std::vector<DecodedField>& fields) {
    std::string text;
    for (const DecodedField& field : fields) {
        if (!text.empty()) text += ' ';
        text += field.name + '=' + std::visit(TextValue{}, field.value.content);
    }
    return text;
}

}  // namespace

std::string json_string(std::string_view text) {
    std::string out = "\"";
    for (const char c : text) {
        const auto byte = static_cast<unsigned char>(c);
        if (c == '"' || c == '\\')
            out += {'\\', c};
        else if (byte < 0x20 || byte > 0x7E)
            out += fmt::format("\\u{:04x}", byte);
        else
            out += c;
    }
    return out + '"';
}

std::string json_line(const DecodedMessage& message, std::uint64_t offset) {
    std::string text = fmt::format("{{\"protocol\":{},\"offset\":{},\"bytes\":{},\"id\":{}",
                                   json_string(message.protocol), offset, message.bytes, json_string(message.id));
    if (!message.name.empty()) text += ",\"name\":" + json_string(message.name);
    if (!message.fields.empty()) text += ",\"fields\":" + json_fields(message.fields);
    if (!message.payload.empty()) text += ",\"payload\":\"" + hex_of(message.payload) + '"';
    return text + '}';
}

std::string text_line(const DecodedMessage& message) {
    std::string text = upper_case(message.protocol) + ' ' + (message.name.empty() ? message.id : message.name);
    if (!message.fields.empty()) text += ' ' + text_fields(message.fields);
    if (!message.payload.empty()) text += fmt::format(" {} bytes {}", message.payload.size(), hex_of(message.payload));
    return text;
}

}  // namespace skyloop
