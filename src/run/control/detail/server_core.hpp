/// What the connections of one server share, and what they promise each other. Everything in here is the server
/// thread's alone.
#pragma once

#include <boost/asio/io_context.hpp>
#include <boost/asio/ip/tcp.hpp>
#include <boost/beast/core.hpp>
#include <boost/beast/http.hpp>
#include <memory>
#include <set>
#include <string>
#include <utility>

#include "run/control/control_request.hpp"
#include "run/control/control_server.hpp"

namespace skyloop::inline run {

using TcpSocket = boost::asio::ip::tcp::socket;
using HttpRequest = boost::beast::http::request<boost::beast::http::string_body>;
using HttpResponse = boost::beast::http::response<boost::beast::http::string_body>;

inline constexpr int most_clients = 16;
inline constexpr int most_refused_clients = 48;  ///< that are being told so; more are hung up on without a word

/// The server but its acceptor.
struct ServerCore {
    explicit ServerCore(ControlParts given) : parts(std::move(given)) {}

    ControlParts parts;
    AccessRules rules;
    int clients = 0, refused_clients = 0;
    int most_snapshot_looks = 50;  ///< each after 2 ms, for an answer of now; then a client is told what was last
    std::uint64_t status_sequence = 0;
    std::string status_text;  ///< of that snapshot
    std::uint16_t port = 0;
    std::set<std::string, std::less<>> started;  ///< names of faults that clients have begun, not too many

    /// What a request is answered with now. The status is made once a snapshot, however often it is asked for.
    ControlSources sources(bool with_status);
    bool push(Command command);
};

/// A place among those that may be connected at once.
class ClientSlot {
public:
    explicit ClientSlot(int& count) : count_(&count) { ++count; }
    ClientSlot(ClientSlot&& other) noexcept : count_(std::exchange(other.count_, nullptr)) {}
    ClientSlot& operator=(ClientSlot&&) = delete;
    ~ClientSlot() {
        if (count_ != nullptr) --*count_;
    }

private:
    int* count_;
};

/// The answer as it goes over the wire.
HttpResponse http_response(const ControlResponse& response, bool keep_alive);

/// Reads requests from a socket and answers them, until the client has enough.
void serve_http(ServerCore& core, TcpSocket socket, ClientSlot slot);
/// Tells a client that there is no room, and hangs up.
void refuse_client(ServerCore& core, TcpSocket socket, ClientSlot slot);
/// Goes on with a socket whose request has been allowed as a WebSocket. @param rate snapshots a second
void serve_stream(ServerCore& core, TcpSocket socket, ClientSlot slot, std::pair<HttpRequest, double> request_and_rate);

}  // namespace skyloop::inline run
