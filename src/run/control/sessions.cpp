#include <boost/asio/read.hpp>
#include <boost/asio/steady_timer.hpp>
#include <boost/asio/write.hpp>
#include <boost/beast/websocket.hpp>

#include <array>
#include <chrono>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

#include "base/core/number_text.hpp"
#include "detail/chunked_body.hpp"
#include "detail/server_core.hpp"
#include "run/control/status_json.hpp"

namespace skyloop::inline run {
namespace {

namespace http = boost::beast::http;
using boost::beast::error_code;

constexpr std::chrono::seconds request_patience{10}, drain_patience{2};
constexpr std::chrono::milliseconds snapshot_look{2};
constexpr std::size_t most_drained_bytes = std::size_t{32} << 20U;

std::string as_string(boost::beast::string_view text) { return {text.data(), text.size()}; }

constexpr std::string_view go_on_answer = "HTTP/1.1 100 Continue\r\n\r\n";

// The client holds its body back until it is told to go on (RFC 9110, section 10.1.1).
bool waits_to_go_on(const HttpRequest& message) {
    return message.version() >= 11 && boost::beast::iequals(message[http::field::expect], "100-continue");
}

ControlRequest control_request(HttpRequest&& message) {
    ControlRequest request;
    request.method = as_string(message.method_string());
    request.target = as_string(message.target());
    for (const auto& field : message.base())
        request.headers.emplace_back(as_string(field.name_string()), as_string(field.value()));
    request.body = std::move(message.body());
    request.version = static_cast<int>(message.version());
    request.take_absolute_form();
    return request;
}

// What a client is told whose bytes are no request; nothing for one that is gone.
std::optional<ControlResponse> request_mistake(const error_code& error) {
    if (error == http::error::body_limit)
        return error_response(413, "the body is too large; expected at most 65536 bytes");
    if (error == http::error::header_limit || error == http::error::buffer_overflow)
        return error_response(431, "the headers are too large; expected at most 8192 bytes");
    if (error == http::error::partial_message || error == http::error::end_of_stream) return std::nullopt;
    if (error.category() == http::make_error_code(http::error::bad_method).category())
        return error_response(400, "this is no HTTP request: " + error.message());
    return std::nullopt;
}

// Snapshots a second that a stream is asked for.
std::optional<double> stream_rate(const ControlRequest& request) {
    const auto text = request.query("rate");
    if (!text) return 2.0;
    const auto rate = number_in<double>(*text);
    return rate && *rate >= 1 && *rate <= 10 ? rate : std::nullopt;
}

class HttpSession : public std::enable_shared_from_this<HttpSession> {
public:
    HttpSession(ServerCore& core, TcpSocket socket, ClientSlot slot)
        : core_(core), stream_(std::move(socket)), slot_(std::move(slot)), timer_(stream_.get_executor()) {}

    void read() {
        parser_.emplace();
        parser_->header_limit(control_header_limit);
        parser_->body_limit(control_body_limit);
        stream_.expires_after(request_patience);
        http::async_read_header(stream_, buffer_, *parser_,
                                boost::beast::bind_front_handler(&HttpSession::on_header, shared_from_this()));
    }

    /// @param head what is asked for: the body is told of, and not sent
    void write(const ControlResponse& response, bool keep_alive, bool head = false) {
        response_ = http_response(response, keep_alive);
        if (head) response_.body().clear();
        stream_.expires_after(request_patience);
        http::async_write(stream_, response_,
                          boost::beast::bind_front_handler(&HttpSession::on_written, shared_from_this(), keep_alive));
    }

private:
    void on_header(error_code error, std::size_t bytes) {
        if (error) return on_read(error, bytes);
        if (parser_->is_done() || !waits_to_go_on(parser_->get())) return read_body();
        if (auto refused = refusal(control_request(HttpRequest(parser_->get())), core_.rules))
            return write(*refused, false);
        boost::asio::async_write(stream_, boost::asio::buffer(go_on_answer),
                                 [self = shared_from_this()](error_code failed, std::size_t) {
                                     if (!failed) self->read_body();
                                 });
    }

    void read_body() {
        const std::size_t missing = bytes_before_body(*parser_, buffer_.size());
        if (missing == 0) return read_rest();
        boost::asio::async_read(stream_, buffer_.prepare(missing),
                                [self = shared_from_this()](error_code error, std::size_t bytes) {
                                    self->buffer_.commit(bytes);
                                    if (error) return self->on_read(error, bytes);
                                    self->read_rest();
                                });
    }

    void read_rest() {
        http::async_read(stream_, buffer_, *parser_,
                         boost::beast::bind_front_handler(&HttpSession::on_read, shared_from_this()));
    }

    void on_read(error_code error, std::size_t) {
        if (error) {
            if (auto told = request_mistake(error)) write(*told, false);
            return;
        }
        HttpRequest message = parser_->release();
        if (boost::beast::websocket::is_upgrade(message)) return upgrade(std::move(message));
        keep_alive_ = message.keep_alive();
        request_ = control_request(std::move(message));
        const bool of_now = request_.path() == "/api/status" || request_.path() == "/api/timeline";
        if (!of_now || refusal(request_, core_.rules)) return tell();
        tell_of_now(core_.parts.board.ask(), core_.most_snapshot_looks);
    }

    // What the client has asked for before, and has seen done, is in the answer.
    void tell_of_now(std::uint64_t asked, int looks) {
        if (looks == 0 || core_.parts.board.latest()->answers >= asked) return tell();
        timer_.expires_after(snapshot_look);
        timer_.async_wait([self = shared_from_this(), asked, looks](error_code error) {
            if (!error) self->tell_of_now(asked, looks - 1);
        });
    }

    void tell() {
        write(answer(request_, core_.rules, core_.sources(request_.path() == "/api/status")), keep_alive_,
              request_.method == "HEAD");
    }

    void upgrade(HttpRequest message) {
        const ControlRequest request = control_request(HttpRequest(message));
        if (auto refused = refusal(request, core_.rules)) return write(*refused, false);
        if (request.path() != "/api/stream")
            return write(error_response(404, "no WebSocket here; expected /api/stream"), false);
        const auto rate = stream_rate(request);
        if (!rate) return write(error_response(400, "'rate' is no number from 1 to 10"), false);
        stream_.expires_never();
        serve_stream(core_, stream_.release_socket(), std::move(slot_), {std::move(message), *rate});
    }

    void on_written(bool keep_alive, error_code error, std::size_t) {
        if (error) return;
        if (keep_alive) return read();
        // A close with bytes unread resets the connection, and the client would not see the answer.
        error_code ignored;
        stream_.socket().shutdown(TcpSocket::shutdown_send, ignored);
        stream_.expires_after(drain_patience);
        drain(0);
    }

    void drain(std::size_t drained) {
        if (drained > most_drained_bytes) return;
        stream_.async_read_some(boost::asio::buffer(waste_),
                                [self = shared_from_this(), drained](error_code error, std::size_t bytes) {
                                    if (!error) self->drain(drained + bytes);
                                });
    }

    ServerCore& core_;
    boost::beast::tcp_stream stream_;
    ClientSlot slot_;
    boost::asio::steady_timer timer_;
    ControlRequest request_;
    bool keep_alive_ = false;
    boost::beast::flat_buffer buffer_{control_header_limit + control_body_limit + 4096};
    std::optional<http::request_parser<http::string_body>> parser_;
    HttpResponse response_;
    std::array<char, 16384> waste_{};
};

}  // namespace

HttpResponse http_response(const ControlResponse& response, bool keep_alive) {
    HttpResponse message(static_cast<http::status>(response.status), 11);
    message.set(http::field::server, "skyloop");
    message.set(http::field::content_type, response.content_type);
    message.set("X-Content-Type-Options", "nosniff");
    for (const auto& [name, value] : response.headers)
        message.set(name, value);
    message.keep_alive(keep_alive);
    message.body() = response.body;
    message.prepare_payload();
    return message;
}

void serve_http(ServerCore& core, TcpSocket socket, ClientSlot slot) {
    std::make_shared<HttpSession>(core, std::move(socket), std::move(slot))->read();
}

void refuse_client(ServerCore& core, TcpSocket socket, ClientSlot slot) {
    std::make_shared<HttpSession>(core, std::move(socket), std::move(slot))
        ->write(error_response(503, "too many clients; expected at most 16 at once"), false);
}

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

}  // namespace skyloop::inline run
