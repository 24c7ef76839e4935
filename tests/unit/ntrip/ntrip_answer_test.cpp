#include "wire/ntrip/ntrip_answer.hpp"

#include <gtest/gtest.h>

#include "wire/ntrip/ntrip_messages.hpp"

namespace skyloop {
namespace {

using Kind = NtripVerdict::Kind;

struct Read {
    std::optional<NtripVerdict> verdict;
    std::string body;
    bool over = false;
};

Read read_in_pieces(std::string_view text, std::size_t piece) {
    NtripAnswer answer;
    Read read;
    for (std::size_t at = 0; at < text.size(); at += piece)
        read.body += to_string(answer.feed(to_bytes(text.substr(at, piece))));
    read.verdict = answer.verdict();
    read.over = answer.over();
    return read;
}

// However it arrives.
void expect_answer(std::string_view text, Kind kind, int version, std::string_view body, bool over) {
    for (const std::size_t piece : {std::size_t{1}, std::size_t{2}, std::size_t{7}, text.size()}) {
        const Read read = read_in_pieces(text, piece);
        ASSERT_TRUE(read.verdict) << text;
        EXPECT_EQ(read.verdict->kind, kind) << text;
        EXPECT_EQ(read.verdict->version, version) << text;
        EXPECT_EQ(read.body, body) << text << " in pieces of " << piece;
        EXPECT_EQ(read.over, over) << text;
    }
}

TEST(NtripAnswer, OfVersion1EndsItsHeadInThreeWays) {
    for (const char* head : {"ICY 200 OK\r\n", "ICY 200 OK\r\n\r\n", "ICY 200 OK\r\nServer: a\r\nDate: b\r\n\r\n"})
        expect_answer(std::string(head) + "\xD3\x00\x13 data\r\n", Kind::stream, 1, "\xD3\x00\x13 data\r\n", false);
    expect_answer("ICY 200 OK\r\n$GPGGA,1\r\n", Kind::stream, 1, "$GPGGA,1\r\n", false);
}

TEST(NtripAnswer, OfVersion2IsTakenOutOfItsChunks) {
    NtripRequest request;
    request.version = 2;
    request.chunked = true;
    const std::string begin = ntrip_stream_answer(request) + ntrip_chunk("first ") + ntrip_chunk("second");
    expect_answer(begin, Kind::stream, 2, "first second", false);
    expect_answer(begin + "0\r\n\r\n", Kind::stream, 2, "first second", true);
    expect_answer(ntrip_stream_answer(request) + "0\r\n\r\n", Kind::stream, 2, "", true);
    expect_answer(begin + "what?\r\n", Kind::stream, 2, "first second", true);
    request.chunked = false;
    expect_answer(ntrip_stream_answer(request) + "abc", Kind::stream, 2, "abc", false);
}

TEST(NtripAnswer, MayBeATable) {
    NtripRequest request;
    expect_answer(ntrip_table_answer(request, "STR;A\r\n"), Kind::table, 1, "STR;A\r\n", true);
    expect_answer("SOURCETABLE 200 OK\r\n\r\nSTR;A;\r\n", Kind::table, 1, "STR;A;\r\n", false);
    request.version = 2;
    expect_answer(ntrip_table_answer(request, "STR;A\r\n"), Kind::table, 2, "STR;A\r\n", true);
}

TEST(NtripAnswer, MayBeARefusal) {
    NtripRequest request;
    EXPECT_EQ(read_in_pieces(ntrip_password_answer(request), 1).verdict->kind, Kind::bad_password);
    EXPECT_EQ(read_in_pieces("ERROR - Bad Password\r\n", 1).verdict->kind, Kind::bad_password);
    EXPECT_EQ(read_in_pieces("ERROR - Mount Point Taken\r\n", 3).verdict->kind, Kind::refused);
    request.version = 2;
    EXPECT_EQ(read_in_pieces(ntrip_missing_answer(request, ""), 5).verdict->kind, Kind::no_such_mount);
    const Read busy = read_in_pieces(ntrip_refusal(503, "Service Unavailable", "too many clients"), 4);
    EXPECT_EQ(busy.verdict->kind, Kind::refused);
    EXPECT_EQ(busy.verdict->line, "HTTP/1.1 503 Service Unavailable");
}

// RTKLIB's caster says no more.
TEST(NtripAnswer, MayBeALineAndNothing) {
    for (const auto& [line, kind] : {std::pair{"HTTP/1.0 401 Unauthorized\r\n", Kind::bad_password},
                                     {"HTTP/1.0 404 No\r\n", Kind::no_such_mount},
                                     {"HTTP/1.0 503 Busy\r\n", Kind::refused},
                                     {"HTTP/1.0 200 OK\r\n", Kind::foreign}}) {
        NtripAnswer answer;
        answer.feed(to_bytes(line));
        EXPECT_FALSE(answer.verdict());
        answer.finish();
        ASSERT_TRUE(answer.verdict()) << line;
        EXPECT_EQ(answer.verdict()->kind, kind) << line;
        EXPECT_EQ(answer.verdict()->line + "\r\n", line);
    }
    NtripAnswer nothing;
    nothing.finish();
    EXPECT_FALSE(nothing.verdict());
}

TEST(NtripAnswer, MayBeOfSomebodyElse) {
    for (const char* foreign : {"SSH-2.0-OpenSSH_9.2\r\n", "HTTP/1.1 200 OK\r\nContent-Type: text/html\r\n\r\n<html>",
                                "HTTP/1.1 what\r\n\r\n", "\x1b[2J garbage", "ICX"}) {
        const Read read = read_in_pieces(foreign, 3);
        ASSERT_TRUE(read.verdict) << foreign;
        EXPECT_EQ(read.verdict->kind, Kind::foreign) << foreign;
        EXPECT_EQ(read.verdict->line.find('\x1b'), std::string::npos);
    }
    EXPECT_FALSE(read_in_pieces("ICY 20", 2).verdict);
    EXPECT_EQ(read_in_pieces(std::string("ERROR - ") + std::string(20000, 'x'), 1000).verdict->kind, Kind::foreign);
}

TEST(NtripAnswer, HasNoHeadWithoutEnd) {
    std::string text = "HTTP/1.1 200 OK\r\n";
    for (int i = 0; i < 2000; ++i)
        text += "A: bbbbbbbbbbbbbbbbbbbb\r\n";
    const Read read = read_in_pieces(text, 500);
    ASSERT_TRUE(read.verdict);
    EXPECT_EQ(read.verdict->kind, Kind::foreign);
    EXPECT_TRUE(read.over);
}

}  // namespace
}  // namespace skyloop
