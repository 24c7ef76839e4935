// Any bytes of a Telnet client: how they are split over calls makes no difference, answers are bounded and whole.
#include <algorithm>
#include <cstdint>
#include <utility>

#include "require.hpp"
#include "wire/transport/rfc2217.hpp"

namespace {

using namespace skyloop;

struct Heard {
    Bytes data, answers;
    ComPortSettings settings;
};

void keep(Heard& heard, ComPortServer& port) {
    for (auto [whole, part] : {std::pair{&heard.data, port.take_data()}, {&heard.answers, port.take_answers()}})
        whole->insert(whole->end(), part.begin(), part.end());
}

// @param piece bytes of each call
Heard heard_in_pieces(ByteSpan bytes, std::size_t piece) {
    ComPortServer port("fuzz");
    port.begin();
    Heard heard;
    while (!bytes.empty()) {
        const std::size_t offered = std::min(piece, bytes.size());
        const std::size_t taken = port.receive(bytes.first(offered));
        require(taken > 0 || offered == 0);  // data has been taken: it goes on
        bytes = bytes.subspan(taken);
        keep(heard, port);
    }
    port.receive({});  // a change of speed that waited
    keep(heard, port);
    heard.settings = port.settings();
    return heard;
}

// Outside commands an answer holds nothing: it is commands only, each of them whole.
void require_whole(const Bytes& answers) {
    ComPortServer reader("reader");
    for (ByteSpan rest = answers; !rest.empty();) {
        const std::size_t taken = reader.receive(rest);
        require(taken > 0);  // it stops behind many commands alone
        rest = rest.subspan(taken);
    }
    require(reader.data_waiting() == 0);
    reader.receive(Bytes{'x'});
    require(reader.take_data() == Bytes{'x'});
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    if (size < 2 || size > 4096) return 0;
    const ByteSpan bytes(data + 1, size - 1);
    const Heard whole = heard_in_pieces(bytes, bytes.size());
    const Heard parts = heard_in_pieces(bytes, 1U + data[0] % 16U);
    require(whole.settings == parts.settings);
    require(whole.answers == parts.answers);
    require_whole(whole.answers);
    require(whole.data.size() <= bytes.size() && parts.data.size() <= bytes.size());
    return 0;
}
