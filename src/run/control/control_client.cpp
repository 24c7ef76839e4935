#include "run/control/control_client.hpp"

#include <fmt/format.h>

#include <boost/asio/io_context.hpp>
#include <boost/asio/ip/tcp.hpp>
#include <boost/asio/read.hpp>
#include <boost/beast/core.hpp>
#include <boost/beast/http.hpp>
#include <boost/beast/websocket.hpp>
#include <optional>

#include "detail/chunked_body.hpp"

namespace skyloop::inline run {
namespace {

constexpr std::size_t longest_answer = std::size_t{64} << 20U;

std::string address_text(const ControlOptions& options) {
    const std::string port = ":" + std::to_string(options.port);
    return options.host.find(':') == std::string::npos ? options.host + port : "[" + options.host + "]" + port;
}

// Calls that wait, each with an end.
class ClientConnection {
public:
    using ErrorCode = boost::beast::error_code;
    ClientConnection(const ControlOptions& options, std::chrono::milliseconds patience)
        : options_(options), patience_(patience) {}

    Result<void> connect() {
        ErrorCode error;
        const auto found =
            boost::asio::ip::tcp::resolver(io_).resolve(options_.host, std::to_string(options_.port), error);
        if (!error) error = wait([&](auto done) { stream.async_connect(found, done); });
        return error ? Result<void>(failure(error)) : Result<void>();
    }

    /// @param begin is given what to call in the end
    template <class Begin>
    ErrorCode wait(Begin begin, bool limited = true) {
        ErrorCode result;
        bool called = false;
        if (limited) stream.expires_after(patience_);
        begin([&](ErrorCode error, auto&&...) {
            result = error;
            called = true;
        });
        io_.restart();
        // No longer than that: a refused stream's timer may still run.
        while (!called && io_.run_one() > 0) {
        }
        return result;
    }

    [[nodiscard]] tl::unexpected<Error> failure(const ErrorCode& error) const {
        return fail(skyloop::ErrorCode::outside, fmt::format("{}: no run with --control answers there: {}",
                                                             address_text(options_), error.message()));
    }

private:
    const ControlOptions& options_;
    std::chrono::milliseconds patience_;
    boost::asio::io_context io_;

public:
    boost::beast::tcp_stream stream{io_};
    boost::beast::flat_buffer buffer;
};

using ClientRequest = boost::beast::http::request<boost::beast::http::string_body>;

ClientRequest client_request(const ControlOptions& options, const ControlRequest& request) {
    ClientRequest message;
    message.version(11);
    message.method_string(request.method);
    message.target(request.target);
    message.set(boost::beast::http::field::host, address_text(options));
    message.set(boost::beast::http::field::connection, "close");
    if (!options.token.empty()) message.set(boost::beast::http::field::authorization, "Bearer " + options.token);
    if (!request.body.empty()) message.set(boost::beast::http::field::content_type, "application/json");
    for (const auto& [name, value] : request.headers)
        message.set(name, value);
    message.body() = request.body;
    message.prepare_payload();
    return message;
}

using AnswerParser = boost::beast::http::response_parser<boost::beast::http::string_body>;

ClientConnection::ErrorCode read_answer(ClientConnection& connection, AnswerParser& parser) {
    namespace http = boost::beast::http;
    auto& stream = connection.stream;
    auto& buffer = connection.buffer;
    auto error = connection.wait([&](auto done) { http::async_read_header(stream, buffer, parser, done); });
    if (error) return error;
    if (const std::size_t missing = bytes_before_body(parser, buffer.size()); missing > 0) {
        error =
            connection.wait([&](auto done) { boost::asio::async_read(stream, buffer.prepare(missing), done); }, false);
        if (error) return error;
        buffer.commit(missing);
    }
    return connection.wait([&](auto done) { http::async_read(stream, buffer, parser, done); }, false);
}

// What a stream was refused with.
tl::unexpected<Error> refused_stream(const boost::beast::websocket::response_type& response) {
    return fail(ErrorCode::outside,
                fmt::format("the stream is refused with status {}: {}", response.result_int(), response.body()));
}

}  // namespace

Result<ControlResponse> ControlClient::ask(const ControlRequest& request) const {
    ClientConnection connection(options_, patience_);
    if (auto connected = connection.connect(); !connected) return fail(connected.error());
    const ClientRequest message = client_request(options_, request);
    auto error = connection.wait([&](auto done) { boost::beast::http::async_write(connection.stream, message, done); });
    // One who refuses early may stop reading; the answer may be there all the same.
    AnswerParser parser;
    parser.body_limit(longest_answer);
    error = read_answer(connection, parser);
    if (error) return connection.failure(error);
    ControlResponse response;
    response.status = static_cast<int>(parser.get().result_int());
    for (const auto& field : parser.get().base())
        response.headers.emplace_back(std::string(field.name_string()), std::string(field.value()));
    response.content_type = std::string(parser.get()[boost::beast::http::field::content_type]);
    response.body = std::move(parser.get().body());
    return response;
}

Result<void> ControlClient::watch(double rate, const std::function<bool(std::string_view json)>& each) const {
    namespace websocket = boost::beast::websocket;
    ClientConnection connection(options_, patience_);
    if (auto connected = connection.connect(); !connected) return fail(connected.error());
    connection.stream.expires_never();
    websocket::stream<boost::beast::tcp_stream&> stream(connection.stream);
    stream.set_option(websocket::stream_base::timeout{patience_, websocket::stream_base::none(), false});
    stream.read_message_max(longest_answer);
    stream.set_option(websocket::stream_base::decorator([&](websocket::request_type& request) {
        if (!options_.token.empty()) request.set(boost::beast::http::field::authorization, "Bearer " + options_.token);
    }));
    websocket::response_type response;
    const std::string target = fmt::format("/api/stream?rate={:g}", rate), host = address_text(options_);
    auto error = connection.wait([&](auto done) { stream.async_handshake(response, host, target, done); }, false);
    if (error == websocket::error::upgrade_declined) return refused_stream(response);
    if (error) return connection.failure(error);
    for (;;) {
        connection.buffer.clear();
        error = connection.wait([&](auto done) { stream.async_read(connection.buffer, done); }, false);
        if (error == websocket::error::closed || error == boost::asio::error::eof) return {};
        if (error) return connection.failure(error);
        const auto data = connection.buffer.cdata();
        if (!each({static_cast<const char*>(data.data()), data.size()})) return {};
    }
}

}  // namespace skyloop::inline run
