#include <boost/asio/steady_timer.hpp>
#include <boost/beast/websocket.hpp>
#include <chrono>
#include <string>

#include "detail/server_core.hpp"
#include "run/control/status_json.hpp"

namespace skyloop {
namespace {

namespace websocket = boost::beast::websocket;

constexpr std::chrono::seconds handshake_patience{5}, idle_patience{30};
constexpr std::size_t most_incoming_bytes = 1024;
constexpr boost::beast::string_view stream_subprotocol = "skyloop";

bool offers_subprotocol(const HttpRequest& request) {
    boost::beast::http::token_list list(request[boost::beast::http::field::sec_websocket_protocol]);
    return list.exists(stream_subprotocol);
}

// A display. One snapshot at most is on its way to it: one that does not read loses those that come meanwhile.
class StreamSession : public std::enable_shared_from_this<StreamSession> {
public:
    StreamSession(ServerCore& core, TcpSocket socket, ClientSlot slot, double rate)
        : core_(core),
          stream_(std::move(socket)),
          slot_(std::move(slot)),
          timer_(stream_.get_executor()),
          interval_(std::chrono::duration_cast<std::chrono::steady_clock::duration>(
              std::chrono::duration<double>(1 / rate))) {
        core_.parts.board.watch();
    }
    StreamSession(const StreamSession&) = delete;
    StreamSession& operator=(const StreamSession&) = delete;
    ~StreamSession() { core_.parts.board.unwatch(); }

    void accept(HttpRequest request) {
        request_ = std::move(request);
        websocket::stream_base::timeout timeout{handshake_patience, idle_patience, true};
        stream_.set_option(timeout);
        stream_.read_message_max(most_incoming_bytes);
        const bool named = offers_subprotocol(request_);
        stream_.set_option(websocket::stream_base::decorator([named](websocket::response_type& response) {
            response.set(boost::beast::http::field::server, "skyloop");
            if (named) response.set(boost::beast::http::field::sec_websocket_protocol, stream_subprotocol);
        }));
        stream_.async_accept(request_, boost::beast::bind_front_handler(&StreamSession::on_accept, shared_from_this()));
    }

private:
    void on_accept(boost::beast::error_code error) {
        if (error) return;
        stream_.text(true);
        read();
        due_ = std::chrono::steady_clock::now();
        tick();
    }

    // What a display says is not wanted; reading it answers its pings and sees it go.
    void read() {
        stream_.async_read(incoming_, [self = shared_from_this()](boost::beast::error_code error, std::size_t) {
            self->incoming_.clear();
            if (!error) return self->read();
            self->gone_ = true;
            self->timer_.cancel();
        });
    }

    void tick() {
        if (gone_) return;
        if (!writing_) send();
        due_ = std::max(due_ + interval_, std::chrono::steady_clock::now());
        timer_.expires_at(due_);
        timer_.async_wait([self = shared_from_this()](boost::beast::error_code error) {
            if (!error) self->tick();
        });
    }

    void send() {
        const auto snapshot = core_.parts.board.latest();
        if (!snapshot || snapshot->sequence == sent_) return;
        sent_ = snapshot->sequence;
        text_ = status_json(*snapshot, seen_);
        seen_ = last_lines(*snapshot);
        writing_ = true;
        stream_.async_write(boost::asio::buffer(text_),
                            [self = shared_from_this()](boost::beast::error_code error, std::size_t) {
                                self->writing_ = false;
                                if (error) self->gone_ = true;
                            });
    }

    ServerCore& core_;
    websocket::stream<boost::beast::tcp_stream> stream_;
    ClientSlot slot_;
    boost::asio::steady_timer timer_;
    std::chrono::steady_clock::duration interval_;
    std::chrono::steady_clock::time_point due_{};
    HttpRequest request_;
    boost::beast::flat_buffer incoming_{most_incoming_bytes * 2};
    std::string text_;
    SeenLines seen_;
    std::uint64_t sent_ = 0;
    bool writing_ = false, gone_ = false;
};

}  // namespace

void serve_stream(ServerCore& core, TcpSocket socket, ClientSlot slot,
                  std::pair<HttpRequest, double> request_and_rate) {
    std::make_shared<StreamSession>(core, std::move(socket), std::move(slot), request_and_rate.second)
        ->accept(std::move(request_and_rate.first));
}

}  // namespace skyloop
