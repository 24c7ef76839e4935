// `skyloop decode`, with the names of configuration keys: the receiver knows them, the protocol layer does not.

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <chrono>
#include <csignal>
#include <cstdio>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "base/core/archive.hpp"
#include "base/core/can_frame.hpp"
#include "base/core/files.hpp"
#include "commands.hpp"
#include "file_streams.hpp"
#include "firmware/ublox/config/config_keys.hpp"
#include "messages.hpp"
#include "receiver/protocol/decoded_message.hpp"
#include "receiver/protocol/dronecan_listing.hpp"
#include "run_options.hpp"
#include "run_session.hpp"

namespace skyloop::host {

namespace {

DecodedValue name_of(const DecodedValue& key) {
    const auto* id = std::get_if<std::uint64_t>(&key.content);
    const auto* known = id == nullptr ? nullptr : firmware::find_config_key(static_cast<std::uint32_t>(*id));
    if (known == nullptr) return {};
    return {std::string(known->name)};
}

void name_pair(DecodedValue& pair) {
    auto* fields = std::get_if<std::vector<DecodedField>>(&pair.content);
    if (fields == nullptr || fields->empty()) return;
    DecodedField name{"name", name_of(fields->front().value)};
    fields->insert(fields->begin() + 1, std::move(name));
}

// Adds to CFG-VALSET and CFG-VALGET a `name` beside each `key` of `pairs`, and to CFG-VALGET and CFG-VALDEL the list
// `names` after `keys`. A key that is not known has no name. Other messages stay as they are.
void name_config_keys(DecodedMessage& message) {
    if (message.protocol != "ubx" || !message.name.starts_with("CFG-VAL")) return;
    for (std::size_t i = 0; i < message.fields.size(); ++i) {
        auto* values = std::get_if<std::vector<DecodedValue>>(&message.fields[i].value.content);
        if (values == nullptr) continue;
        if (message.fields[i].name == "pairs") {
            for (DecodedValue& pair : *values)
                name_pair(pair);
        } else if (message.fields[i].name == "keys") {
            std::vector<DecodedValue> names;
            for (const DecodedValue& key : *values)
                names.push_back(name_of(key));
            message.fields.insert(message.fields.begin() + static_cast<std::ptrdiff_t>(i) + 1,
                                  {"names", {std::move(names)}});
            return;
        }
    }
}

constexpr std::array<StreamKind, 9> all_kinds{StreamKind::ubx,     StreamKind::nmea,    StreamKind::rtcm3,
                                              StreamKind::msp,     StreamKind::mavlink, StreamKind::sbf,
                                              StreamKind::unicore, StreamKind::can,     StreamKind::casic};
// What switches each of these on.
constexpr std::array<bool StreamProtocols::*, 9> protocol_flags{
    &StreamProtocols::ubx,     &StreamProtocols::nmea,    &StreamProtocols::rtcm3,
    &StreamProtocols::msp,     &StreamProtocols::mavlink, &StreamProtocols::sbf,
    &StreamProtocols::unicore, &StreamProtocols::can,     &StreamProtocols::casic};

// A tty that is silent for so long has sent all of its frame (RECEIVER.md 1.3).
constexpr std::chrono::seconds frame_silence{2};

struct DecodeOptions {
    std::string input = "-";
    std::string format = "text";
    std::vector<std::string> protocols{"auto"};
    Verbosity verbosity;
};

// The options, understood.
struct Wanted {
    StreamProtocols protocols;
    std::vector<StreamKind> named;  // by the user; empty: all that are found
};

bool is_automatic(const std::vector<std::string>& words) { return std::ranges::find(words, "auto") != words.end(); }

Wanted wanted_of(const std::vector<std::string>& words) {
    Wanted wanted;
    const bool automatic = is_automatic(words);
    for (std::size_t i = 0; i < all_kinds.size(); ++i) {
        const bool named = std::ranges::find(words, stream_kind_name(all_kinds[i])) != words.end();
        wanted.protocols.*protocol_flags[i] = automatic || named;
        if (named) wanted.named.push_back(all_kinds[i]);
    }
    return wanted;
}

// A log of candump as the lines of SLCAN that it means. State: the unfinished line.
class CandumpLog {
public:
    Bytes slcan_of(ByteSpan bytes) {
        std::string lines;
        for (const std::uint8_t byte : bytes) {
            if (byte != '\n') {
                if (line_.size() < longest) line_.push_back(static_cast<char>(byte));
                continue;
            }
            if (const auto frame = parse_candump_line(line_)) lines += slcan_line(*frame);
            line_.clear();
        }
        return to_bytes(lines);
    }

private:
    static constexpr std::size_t longest = 256;
    std::string line_;
};

// One stream from its first byte to its counts.
class Decoder {
public:
    Decoder(const DecodeOptions& options, const Wanted& wanted)
        : json_(options.format == "json"), wanted_(wanted), splitter_(wanted.protocols) {}

    // False when standard output takes no more.
    bool take(ByteSpan bytes, bool flush) {
        if (!candump_ && splitter_.counts().bytes == 0 && wanted_.protocols.can && !bytes.empty() && bytes[0] == '(')
            candump_.emplace();
        const Bytes frames = candump_ ? candump_->slcan_of(bytes) : Bytes();
        for (const StreamPiece& piece : splitter_.feed(candump_ ? ByteSpan(frames) : bytes))
            print(piece, flush);
        return std::ferror(stdout) == 0;
    }
    void finish() {
        for (const StreamPiece& piece : splitter_.finish())
            print(piece, true);
    }
    [[nodiscard]] std::uint64_t frames() const {
        std::uint64_t all = 0;
        for (const std::uint64_t count : splitter_.counts().frames)
            all += count;
        return all;
    }
    [[nodiscard]] std::uint64_t bytes() const { return splitter_.counts().bytes; }

    // "ubx 12 frames, 0 bad; … ; 40 of 5000 bytes skipped"
    [[nodiscard]] std::string counts_text() const {
        std::string text;
        for (const StreamKind kind : counted())
            text += fmt::format("{} {} frames, {} bad; ", stream_kind_name(kind),
                                splitter_.counts().frames[index(kind)], splitter_.counts().bad[index(kind)]);
        return text + fmt::format("{} of {} bytes skipped", splitter_.counts().skipped, splitter_.counts().bytes);
    }
    void print_counts() const {
        if (!json_) return;
        std::string text = fmt::format("{{\"counts\":{{\"bytes\":{},\"skipped_bytes\":{}", splitter_.counts().bytes,
                                       splitter_.counts().skipped);
        for (const StreamKind kind : counted())
            text += fmt::format(",\"{}\":{{\"frames\":{},\"bad\":{}}}", stream_kind_name(kind),
                                splitter_.counts().frames[index(kind)], splitter_.counts().bad[index(kind)]);
        fmt::print("{}}}}}\n", text);
    }

private:
    static std::size_t index(StreamKind kind) { return static_cast<std::size_t>(kind); }

    void print(const StreamPiece& piece, bool flush) {
        const std::uint64_t offset = offset_;
        offset_ += piece.bytes.size();
        if (piece.kind == StreamKind::noise || std::ferror(stdout) != 0) return;
        DecodedMessage message = decode_piece(piece);
        if (piece.kind == StreamKind::can && !join_frames(piece, message)) return;
        name_config_keys(message);
        const std::string line = (json_ ? json_line(message, offset) : text_line(message)) + '\n';
        std::fwrite(line.data(), 1, line.size(), stdout);
        if (flush) std::fflush(stdout);
    }
    // What a transfer of several frames says is shown with its last one. False for those before it.
    bool join_frames(const StreamPiece& piece, DecodedMessage& message) {
        const std::string line = to_string(piece.bytes);
        const auto frame = parse_slcan_line(std::string_view(line).substr(0, line.find('\r')));
        const auto head = frame ? dronecan_head(*frame) : std::nullopt;
        if (!head || find_dronecan_type(head->kind, head->type_id) == nullptr) return true;
        const auto transfer = transfers_.take(*frame, {});
        if (transfer) list_dronecan(*transfer, message);
        return transfer.has_value();
    }
    // A dollar or a byte of 0xFE in another stream is no failed frame of a protocol that never speaks there.
    [[nodiscard]] std::vector<StreamKind> counted() const {
        if (!wanted_.named.empty()) return wanted_.named;
        std::vector<StreamKind> kinds;
        for (const StreamKind kind : all_kinds)
            if (kind == StreamKind::ubx || kind == StreamKind::nmea || kind == StreamKind::rtcm3 ||
                splitter_.counts().frames[index(kind)] > 0)
                kinds.push_back(kind);
        return kinds;
    }

    bool json_;
    Wanted wanted_;
    StreamSplitter splitter_;
    TransferReceiver transfers_;
    std::optional<CandumpLog> candump_;  // nothing: another stream
    std::uint64_t offset_ = 0;
};

Result<void> decode_stream(InputStream& input, const std::string& path, Decoder& decoder) {
    auto last = std::chrono::steady_clock::now();
    bool first = true;
    while (!input.at_end() && !stop_was_asked()) {
        const auto bytes = input.read();
        if (!bytes) return fail(bytes.error());
        const auto now = std::chrono::steady_clock::now();
        if (bytes->empty()) {
            if (input.is_tty() && now - last > frame_silence) decoder.finish();
            continue;
        }
        last = now;
        const std::string_view begin(reinterpret_cast<const char*>(bytes->data()), bytes->size());
        if (first && input.is_file() && path != "-" && (is_compressed(begin) || is_archive(begin))) {
            const auto text = read_text_file(path);
            if (!text) return fail(text.error());
            decoder.take(to_bytes(*text), false);
            return {};
        }
        first = false;
        if (!decoder.take(*bytes, !input.is_file())) return {};
    }
    return {};
}

std::string nothing_in(const DecodeOptions& options, const std::string& name, std::uint64_t bytes) {
    const bool any = is_automatic(options.protocols);
    return fmt::format("{}: no message of {} in its {} bytes{}", name,
                       any ? "UBX, NMEA, RTCM 3, MSP, MAVLink, SBF, Unicore, DroneCAN or CASIC"
                           : fmt::format("{}", fmt::join(options.protocols, " or ")),
                       bytes, options.input == "-" ? "; what is packed is unpacked from files alone" : "");
}

int decode(const DecodeOptions& options) {
    const Messages messages(options.verbosity);
    if (options.protocols.size() > 1 && is_automatic(options.protocols))
        return messages.error(
            {ErrorCode::usage, fmt::format("--protocol {}: auto looks for all protocols; expected auto alone, or names "
                                           "of protocols",
                                           fmt::join(options.protocols, ","))});
    struct sigaction inherited {};
    sigaction(SIGPIPE, nullptr, &inherited);
    catch_stop_signals();
    // Who reads a listing through head has seen enough of it.
    sigaction(SIGPIPE, &inherited, nullptr);
    auto input = InputStream::open(options.input);
    if (!input) return messages.error(input.error());
    Decoder decoder(options, wanted_of(options.protocols));
    const auto read = decode_stream(*input, options.input, decoder);
    decoder.finish();
    // A file that is refused as a whole has no counts to tell.
    if (!read && decoder.frames() == 0) return messages.error(read.error());
    decoder.print_counts();
    if (decoder.frames() > 0 || decoder.bytes() == 0 || stop_was_asked()) {
        messages.info(decoder.counts_text());
        return read ? 0 : messages.error(read.error());
    }
    return messages.error({ErrorCode::input, nothing_in(options, input->name(), decoder.bytes())});
}

}  // namespace

Action add_decode_command(CLI::App& app) {
    CLI::App* command =
        app.add_subcommand("decode",
                           "The messages of a UBX, NMEA, RTCM 3, MSP, MAVLink, SBF, Unicore, CASIC or DroneCAN "
                           "(SLCAN, candump) stream as text or JSON lines");
    auto options = std::make_shared<DecodeOptions>();
    command->add_option("FILE", options->input, "File (also .gz, .zip, …), tty or pipe; default: -, standard input");
    command->add_option("--format", options->format, "text or json")->check(CLI::IsMember({"text", "json"}));
    command
        ->add_option(
            "--protocol", options->protocols,
            "What to look for, separated by commas: ubx nmea rtcm3 msp mavlink sbf unicore can casic; default: "
            "auto, all of them")
        ->delimiter(',')
        ->allow_extra_args(false)
        ->check(CLI::IsMember({"auto", "ubx", "nmea", "rtcm3", "msp", "mavlink", "sbf", "unicore", "can", "casic"}));
    add_verbosity_options(*command, options->verbosity);
    return [options] { return decode(*options); };
}

}  // namespace skyloop::host
