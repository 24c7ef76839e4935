#include "receiver/observed/ulog.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <charconv>

#include "detail/observed_parts.hpp"

namespace skyloop::inline receiver {
namespace {

// PX4 user guide, "ULog File Format", as FEEDS.md 1.7 sums it up.
constexpr std::array<std::uint8_t, 7> ulog_magic{0x55, 0x4C, 0x6F, 0x67, 0x01, 0x12, 0x35};
constexpr std::array<std::uint8_t, 8> ulog_sync{0x2F, 0x73, 0x13, 0x20, 0x25, 0x0C, 0xBB, 0x12};
constexpr std::size_t ulog_header = 16, ulog_message_head = 3, ulog_longest = 10000;

std::string_view characters_of(ByteSpan bytes) { return {reinterpret_cast<const char*>(bytes.data()), bytes.size()}; }

struct UlogType {
    std::string_view name;
    std::size_t size;
    double (*read)(ByteSpan record, std::size_t at);
};
template <class Number>
constexpr UlogType ulog_type(std::string_view name) {
    return {name, sizeof(Number), double_at<Number>};
}
constexpr std::array ulog_types{ulog_type<std::int8_t>("int8_t"),   ulog_type<std::uint8_t>("uint8_t"),
                                ulog_type<std::uint8_t>("bool"),    ulog_type<std::uint8_t>("char"),
                                ulog_type<std::int16_t>("int16_t"), ulog_type<std::uint16_t>("uint16_t"),
                                ulog_type<std::int32_t>("int32_t"), ulog_type<std::uint32_t>("uint32_t"),
                                ulog_type<std::int64_t>("int64_t"), ulog_type<std::uint64_t>("uint64_t"),
                                ulog_type<float>("float"),          ulog_type<double>("double")};

// The plain type of that name, or null for a nested format.
const UlogType* plain_type(std::string_view name) {
    const auto found = std::ranges::find(ulog_types, name, &UlogType::name);
    return found == ulog_types.end() ? nullptr : &*found;
}

class UlogParser {
public:
    UlogParser(ByteSpan bytes, const std::string& name, const std::vector<std::string_view>& topics)
        : bytes_(bytes), name_(name), topics_(topics) {}
    Result<Ulog> parse();

private:
    Result<void> take(char type, ByteSpan payload);
    Result<void> take_flags(ByteSpan payload);
    void take_format(std::string_view text);
    void take_subscription(ByteSpan payload);
    void take_data(ByteSpan payload);
    void take_information(ByteSpan payload);
    // Adds the fields of a format; gives its size, or nothing for a format that makes no sense.
    std::optional<std::size_t> flatten(std::string_view format, const std::string& prefix, UlogFields& fields,
                                       std::size_t offset, int depth);
    std::size_t resynchronised(std::size_t at) const;

    ByteSpan bytes_;
    const std::string& name_;
    const std::vector<std::string_view>& topics_;
    Ulog log_;
    std::map<std::string, std::string, std::less<>> formats_;
    struct Subscription {
        std::size_t stream = 0, size = 0, size_without_padding = 0;
    };
    std::map<std::uint16_t, Subscription> subscriptions_;
    std::size_t main_end_ = 0, padding_ = 0;
    std::size_t budget_ = 0;  // fields that one subscription may still have: formats may nest without end
};

Result<Ulog> UlogParser::parse() {
    main_end_ = bytes_.size();
    std::size_t at = ulog_header;
    while (at + ulog_message_head <= bytes_.size()) {
        const std::size_t size = number_at<std::uint16_t>(bytes_, at);
        const auto type = static_cast<char>(bytes_[at + 2]);
        const bool cut = at < main_end_ && at + ulog_message_head + size > main_end_ && main_end_ < bytes_.size();
        if (cut) {  // the last record before what was appended
            ++log_.cut_records;
            at = main_end_;
            continue;
        }
        if (size == 0 || type == 0 || size > ulog_longest) {
            const std::size_t next = resynchronised(at + 1);
            log_.skipped_bytes += next - at;
            at = next;
            continue;
        }
        if (at + ulog_message_head + size > bytes_.size()) {
            ++log_.cut_records;
            break;
        }
        if (auto taken = take(type, bytes_.subspan(at + ulog_message_head, size)); !taken) return fail(taken.error());
        at += ulog_message_head + size;
    }
    return std::move(log_);
}

// The message after the next sync, or the end.
std::size_t UlogParser::resynchronised(std::size_t at) const {
    const auto found =
        std::search(bytes_.begin() + static_cast<std::ptrdiff_t>(at), bytes_.end(), ulog_sync.begin(), ulog_sync.end());
    if (found == bytes_.end()) return bytes_.size();
    return static_cast<std::size_t>(found - bytes_.begin()) + ulog_sync.size();
}

Result<void> UlogParser::take(char type, ByteSpan payload) {
    switch (type) {
        case 'B':
            return take_flags(payload);
        case 'F':
            take_format(characters_of(payload));
            break;
        case 'I':
            take_information(payload);
            break;
        case 'A':
            take_subscription(payload);
            break;
        case 'D':
            take_data(payload);
            break;
        case 'O':
            if (payload.size() >= 2) ++log_.dropouts, log_.dropout_ms += number_at<std::uint16_t>(payload, 0);
            break;
        default:
            break;
    }
    return {};
}

Result<void> UlogParser::take_flags(ByteSpan payload) {
    constexpr std::size_t length = 40;
    if (payload.size() < length) return {};
    constexpr std::uint8_t known = 1;  // data is appended
    for (std::size_t i = 8; i < 16; ++i)
        if ((payload[i] & (i == 8 ? ~known : 0xFF)) != 0)
            return fail(ErrorCode::input,
                        fmt::format("{}: a ULog file with unknown incompatible flag bits 0x{:02x} in byte {}; expected "
                                    "none but 0x01 in byte 0",
                                    name_, payload[i], i - 8));
    const auto appended = number_at<std::uint64_t>(payload, 16);
    if ((payload[8] & known) != 0 && appended > ulog_header && appended < bytes_.size())
        main_end_ = static_cast<std::size_t>(appended);
    return {};
}

void UlogParser::take_format(std::string_view text) {
    const std::size_t colon = text.find(':');
    if (colon != std::string_view::npos) formats_[std::string(text.substr(0, colon))] = text.substr(colon + 1);
}

void UlogParser::take_information(ByteSpan payload) {
    const std::size_t key_size = payload[0];
    if (key_size + 1 > payload.size()) return;
    const std::string_view key = characters_of(payload.subspan(1, key_size));
    if (key.starts_with("char[") && key.ends_with(" ver_hw"))
        log_.hardware = characters_of(payload.subspan(1 + key_size));
}

std::optional<std::size_t> UlogParser::flatten(std::string_view format, const std::string& prefix, UlogFields& fields,
                                               std::size_t offset, int depth) {
    constexpr std::size_t most_fields = 5000;
    const auto found = formats_.find(format);
    if (found == formats_.end() || depth > 8) return std::nullopt;
    const std::size_t begin = offset;
    std::string_view rest = found->second;
    padding_ = 0;
    while (!rest.empty()) {
        const std::size_t end = std::min(rest.find(';'), rest.size());
        const std::string_view field = rest.substr(0, end);
        rest.remove_prefix(std::min(end + 1, rest.size()));
        const std::size_t blank = field.find(' ');
        if (blank == std::string_view::npos) continue;
        std::string_view type = field.substr(0, blank);
        const std::string_view field_name = field.substr(blank + 1);
        std::size_t count = 1;
        const std::size_t bracket = type.find('[');
        if (bracket != std::string_view::npos) {
            std::from_chars(type.data() + bracket + 1, type.data() + type.size(), count);
            type = type.substr(0, bracket);
        }
        if (count > ulog_longest) return std::nullopt;
        const std::size_t field_begin = offset;
        for (std::size_t i = 0; i < count; ++i) {
            if (budget_-- == 0) return std::nullopt;
            std::string key = prefix + std::string(field_name);
            if (bracket != std::string_view::npos) key += fmt::format("[{}]", i);
            const UlogType* plain = plain_type(type);
            if (fields.size() > most_fields || offset > ulog_longest) return std::nullopt;
            if (plain != nullptr) {
                fields[key] = {plain->read, offset, plain->size};
                offset += plain->size;
            } else {
                const auto nested = flatten(type, key + ".", fields, offset, depth + 1);
                if (!nested) return std::nullopt;
                offset += *nested;
            }
        }
        padding_ = field_name.starts_with("_padding") ? offset - field_begin : 0;
    }
    return offset - begin;
}

void UlogParser::take_subscription(ByteSpan payload) {
    if (payload.size() < 4) return;
    const std::string_view topic = characters_of(payload.subspan(3));
    if (std::find(topics_.begin(), topics_.end(), topic) == topics_.end()) return;
    constexpr std::size_t most_streams = 256, most_fields = 20000;
    if (log_.streams.size() >= most_streams) return;
    budget_ = most_fields;
    UlogStream stream;
    stream.topic = topic;
    stream.instance = payload[0];
    const auto size = flatten(topic, "", stream.fields, 0, 0);
    if (!size) return;
    const auto id = number_at<std::uint16_t>(payload, 1);
    subscriptions_[id] = {log_.streams.size(), *size, *size - padding_};
    log_.streams.push_back(std::move(stream));
}

// Trailing padding is not in the record.
void UlogParser::take_data(ByteSpan payload) {
    if (payload.size() < 2) return;
    const auto found = subscriptions_.find(number_at<std::uint16_t>(payload, 0));
    if (found == subscriptions_.end()) return;
    const Subscription& subscription = found->second;
    const ByteSpan record = payload.subspan(2);
    if (record.size() < subscription.size_without_padding || record.size() > subscription.size) {
        ++log_.cut_records;
        return;
    }
    log_.streams[subscription.stream].records.push_back(record);
}

}  // namespace

std::optional<double> UlogRecord::value(std::initializer_list<std::string_view> names) const {
    for (const std::string_view name : names) {
        const auto found = fields_.find(name);
        if (found == fields_.end() || found->second.offset + found->second.size > bytes_.size()) continue;
        return found->second.read(bytes_, found->second.offset);
    }
    return std::nullopt;
}

bool is_ulog(ByteSpan bytes) {
    return bytes.size() >= ulog_magic.size() && std::equal(ulog_magic.begin(), ulog_magic.end(), bytes.begin());
}

Result<Ulog> parse_ulog(ByteSpan bytes, const std::string& name, const std::vector<std::string_view>& topics) {
    if (bytes.size() < ulog_header)
        return fail(ErrorCode::input,
                    fmt::format("{}: a ULog header of {} bytes; expected {}", name, bytes.size(), ulog_header));
    return UlogParser(bytes, name, topics).parse();
}

}  // namespace skyloop::inline receiver
