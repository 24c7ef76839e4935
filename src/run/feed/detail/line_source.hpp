// What dialects of lines have in common: bytes into lines, and what is bad among them.
#pragma once

#include <array>
#include <cstdint>
#include <string>

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

}  // namespace skyloop
