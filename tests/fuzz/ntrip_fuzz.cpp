// NTRIP: any bytes as an answer, a request, an address, a source table and a sentence.
#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>

#include "require.hpp"
#include "wire/ntrip/ntrip_answer.hpp"
#include "wire/ntrip/ntrip_messages.hpp"
#include "wire/ntrip/source_table.hpp"

namespace {

using namespace skyloop;

struct ReadAnswer {
    Bytes body;
    std::optional<NtripVerdict> verdict;
};

ReadAnswer read_in_pieces(ByteSpan bytes, std::size_t piece) {
    NtripAnswer answer;
    ReadAnswer read;
    for (std::size_t at = 0; at < bytes.size() && !answer.over(); at += piece) {
        const Bytes some = answer.feed(bytes.subspan(at, std::min(piece, bytes.size() - at)));
        read.body.insert(read.body.end(), some.begin(), some.end());
    }
    answer.finish();
    read.verdict = answer.verdict();
    return read;
}

bool is_answer(const ReadAnswer& read) { return read.verdict && read.verdict->kind != NtripVerdict::Kind::foreign; }

// However they arrive.
void check_answer(ByteSpan bytes) {
    const ReadAnswer whole = read_in_pieces(bytes, std::max<std::size_t>(bytes.size(), 1));
    const ReadAnswer single = read_in_pieces(bytes, 1);
    require(whole.body.size() <= bytes.size() && single.body.size() <= bytes.size());
    // Of a head that is none, Beast says so at once or when its end has come, by how much it is given.
    if (!is_answer(whole) || !is_answer(single)) return;
    require(whole.body == single.body && whole.verdict->kind == single.verdict->kind);
    require(whole.verdict->version == single.verdict->version && whole.verdict->line == single.verdict->line);
    require(whole.verdict->line.find('\x1b') == std::string::npos);
}

void check_address(std::string_view text) {
    const auto address = parse_ntrip_uri(text);
    if (!address) return require(!address.error().message.empty());
    require(shown_uri(*address) == shown_uri(parse_ntrip_uri(shown_uri(*address)).value()));
    for (const int version : {1, 2}) {
        const auto request = parse_ntrip_request(ntrip_request_text(*address, address->mount, version, ""));
        if (!request) continue;  // a host or a mount point that HTTP does not have
        require(request->version == version && request->password == address->password);
        require(request->user == address->user);
    }
}

void check_request(std::string_view text) {
    const auto request = parse_ntrip_request(text);
    if (!request) return;
    require(request->user.find(':') == std::string::npos);
    for (const std::string& answer : {ntrip_stream_answer(*request), ntrip_table_answer(*request, "ENDSOURCETABLE\r\n"),
                                      ntrip_missing_answer(*request, ""), ntrip_password_answer(*request)})
        require(read_in_pieces(to_bytes(answer), 3).verdict->kind != NtripVerdict::Kind::foreign);
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    const std::string_view text(reinterpret_cast<const char*>(data), size);
    check_answer({data, size});
    check_request(text);
    check_request("GET /" + std::string(text) + " HTTP/1.1\r\n\r\n");
    check_address(text);
    check_address("ntrip://" + std::string(text));
    require(base64_decoded(base64(text)) == text);
    (void)base64_decoded(text);
    for (const std::string& mount : mounts_of(text))
        require(!mount.empty() && mount.find(';') == std::string::npos);
    (void)is_position_sentence(text);
    return 0;
}
