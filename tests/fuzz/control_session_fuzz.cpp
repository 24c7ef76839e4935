// Any bytes as all that a client sends to the control server: through a socket into the session itself, HTTP, upgrade
// and WebSocket frames. The first byte says how the rest is cut into writes. Whatever comes back is HTTP, the session
// ends, its place becomes free, and without the token nothing is commanded.
#include <sys/socket.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstdint>
#include <string>
#include <string_view>

#include "require.hpp"
#include "run/control/detail/server_core.hpp"

namespace {

using namespace skyloop;

constexpr std::size_t most_bytes = 65536;
constexpr int most_turns = 100'000;  // of the loop, far more than any session needs

// What the server says meanwhile.
void drain(int peer, std::string& heard) {
    char bytes[8192];
    for (ssize_t count = 0; (count = ::recv(peer, bytes, sizeof bytes, MSG_DONTWAIT)) > 0;)
        if (heard.size() < most_bytes) heard.append(bytes, static_cast<std::size_t>(count));
}

// One session from its first byte to its last.
std::string session(ServerCore& core, std::string_view text, std::size_t piece) {
    int ends[2];
    require(::socketpair(AF_UNIX, SOCK_STREAM | SOCK_NONBLOCK | SOCK_CLOEXEC, 0, ends) == 0);
    std::string heard;
    {
        boost::asio::io_context io{1};
        TcpSocket socket(io);
        socket.assign(boost::asio::ip::tcp::v4(), ends[0]);
        serve_http(core, std::move(socket), ClientSlot(core.clients));
        bool open = true;
        int turns = 0;
        for (; !io.stopped() && turns < most_turns; ++turns) {
            const std::string_view now = text.substr(0, piece);
            const ssize_t sent = now.empty() ? 0 : ::send(ends[1], now.data(), now.size(), MSG_NOSIGNAL);
            if (sent > 0) text.remove_prefix(static_cast<std::size_t>(sent));
            if (sent < 0 && errno != EAGAIN) text = {};
            if (text.empty() && open) {
                ::shutdown(ends[1], SHUT_WR);
                open = false;
            }
            io.poll();
            drain(ends[1], heard);
        }
        require(turns < most_turns);
    }
    ::close(ends[1]);
    return heard;
}

void check(const AccessRules& rules, std::string_view text, std::size_t piece) {
    static const StatusBoard board{{"fuzz", GpsTime{}, std::nullopt, {}}, nullptr};
    CommandQueue commands;
    ServerCore core({commands, board, "{}", "1"});
    core.rules = rules;
    core.most_snapshot_looks = 0;  // there is no loop that would make one
    const std::string heard = session(core, text, piece);
    require(heard.empty() || heard.starts_with("HTTP/1.1 "));
    require(core.clients == 0 && board.watchers() == 0);
    require(rules.token.empty() || commands.take().empty());
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    if (size == 0) return 0;
    const std::string_view text(reinterpret_cast<const char*>(data) + 1, std::min(size - 1, most_bytes));
    const std::size_t piece = data[0] == 0 ? most_bytes : data[0];
    check({"", "127.0.0.1", true}, text, piece);
    check({"a-secret-that-no-input-has", "0.0.0.0", false}, text, piece);
    return 0;
}
