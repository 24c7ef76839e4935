// What dialects of lines and of receivers' streams have in common: bytes into pieces, and what is bad among them.
#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <string_view>

#include "receiver/protocol/nmea_sentence.hpp"
#include "receiver/protocol/stream_splitter.hpp"
#include "run/feed/feed_dialect.hpp"
#include "source_pose.hpp"

namespace skyloop {

inline constexpr std::array<std::uint8_t, 1> line_end{'\n'};

// A source that speaks in lines of text.
class LineSource : public FeedDialect {
public:
    explicit LineSource(const FeedContext& context) : context_(context) {}

    FeedNews hear(ByteSpan bytes, std::int64_t received_ns) override {
        FeedNews news;
        for (const std::string& line : lines_.feed(bytes))
            take(line, received_ns, news);
        if (context_.datagrams)
            for (const std::string& line : lines_.feed(line_end))
                take(line, received_ns, news);
        if (lines_.take_thrown_away() > 0) report_refusal(news, "a line of more than 65536 bytes");
        return news;
    }
    void reconnected() override { lines_.clear(); }

protected:
    virtual void take(const std::string& line, std::int64_t received_ns, FeedNews& news) = 0;
    [[nodiscard]] const FeedContext& context() const { return context_; }

private:
    FeedContext context_;
    SourceLines lines_;
};

// A receiver's stream, of which messages of one kind are taken.
class StreamSource : public FeedDialect {
public:
    // @param bad_piece why one with a wrong checksum is refused
    StreamSource(const FeedContext& context, StreamKind kind, const char* bad_piece)
        : context_(context), kind_(kind), bad_piece_(bad_piece) {}

    FeedNews hear(ByteSpan bytes, std::int64_t received_ns) override {
        FeedNews news;
        const auto take_all = [&](ByteSpan some) {
            for (const StreamPiece& piece : splitter_.feed(some))
                if (piece.kind == kind_) take(piece.bytes, received_ns, news);
        };
        const bool by_sentences = context_.datagrams && kind_ == StreamKind::nmea;
        if (by_sentences && begins_sentence(bytes)) take_all(line_end);
        take_all(bytes);
        if (by_sentences && ends_sentence(bytes)) take_all(line_end);
        refuse_bad(news);
        return news;
    }
    void reconnected() override {
        splitter_ = StreamSplitter();
        bad_ = unchecked_ = 0;
    }

protected:
    virtual void take(ByteSpan message, std::int64_t received_ns, FeedNews& news) = 0;
    [[nodiscard]] const FeedContext& context() const { return context_; }

private:
    // Sentences in datagrams need no line ends; and those of a stream that somebody sends on in pieces go over the
    // edges of datagrams.
    static bool begins_sentence(ByteSpan bytes) { return !bytes.empty() && (bytes[0] == '$' || bytes[0] == '!'); }
    static bool ends_sentence(ByteSpan bytes) {
        const std::string_view text(reinterpret_cast<const char*>(bytes.data()), bytes.size());
        const std::size_t begin = text.rfind('$');
        return begin != std::string_view::npos && !text.ends_with('\n') && parse_sentence(text.substr(begin));
    }

    void refuse_bad(FeedNews& news) {
        const StreamCounts& counts = splitter_.counts();
        const std::uint64_t bad = counts.bad[static_cast<std::size_t>(kind_)] - bad_;
        const std::uint64_t unchecked = kind_ == StreamKind::nmea ? counts.unchecked - unchecked_ : 0;
        for (std::uint64_t i = 0; i < bad; ++i)
            report_refusal(news, i < unchecked ? "a sentence without a checksum; expected *hh at its end" : bad_piece_);
        bad_ += bad;
        unchecked_ += unchecked;
    }

    FeedContext context_;
    StreamKind kind_;
    const char* bad_piece_;
    StreamSplitter splitter_;
    std::uint64_t bad_ = 0, unchecked_ = 0;  // told of
};

}  // namespace skyloop
