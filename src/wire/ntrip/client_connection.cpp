#include "detail/client_connection.hpp"

#include <fmt/format.h>

#include <array>
#include <atomic>
#include <boost/asio/executor_work_guard.hpp>
#include <boost/asio/io_context.hpp>
#include <boost/asio/ip/tcp.hpp>
#include <boost/asio/ssl.hpp>
#include <boost/asio/steady_timer.hpp>
#include <boost/asio/write.hpp>
#include <boost/beast/core.hpp>
#include <boost/beast/ssl.hpp>

#include "wire/ntrip/ntrip_messages.hpp"

namespace skyloop::inline wire {
namespace {

namespace ssl = boost::asio::ssl;
using boost::asio::ip::tcp;
using AsioError = boost::system::error_code;
using PlainStream = boost::beast::tcp_stream;
using TlsStream = boost::beast::ssl_stream<PlainStream>;
using Kind = NtripVerdict::Kind;

constexpr std::chrono::seconds connect_patience{10}, first_bytes_patience{15}, silence_patience{60};
constexpr std::chrono::milliseconds position_look{200};
constexpr std::size_t longest_table = std::size_t{1} << 20U;

}  // namespace

// Tells the caster where the receiver is, now and then, while somebody else reads from it.
template <class Stream>
class PositionTeller : public std::enable_shared_from_this<PositionTeller<Stream>> {
public:
    PositionTeller(std::shared_ptr<Stream> stream, const ClientInbox& inbox, std::chrono::seconds every)
        : stream_(std::move(stream)), inbox_(inbox), timer_(stream_->get_executor()), every_(every) {}

    /// @param told it has been told in the request
    void start(bool told) {
        if (every_.count() == 0) return;
        due_ = std::chrono::steady_clock::now() + (told ? every_ : std::chrono::seconds(0));
        tick();
    }
    void stop() {
        stopped_ = true;
        timer_.cancel();
    }

private:
    void tick() {
        if (stopped_) return;
        timer_.expires_after(position_look);
        timer_.async_wait([self = this->shared_from_this()](AsioError error) {
            if (!error) self->look();
        });
    }

    void look() {
        if (stopped_) return;
        const auto now = std::chrono::steady_clock::now();
        if (now >= due_ && !writing_) {
            line_ = inbox_.position();
            if (!line_.empty()) {
                line_ += "\r\n";
                due_ = now + every_;
                write();
            }
        }
        tick();
    }

    void write() {
        writing_ = true;
        boost::asio::async_write(*stream_, boost::asio::buffer(line_),
                                 [self = this->shared_from_this()](AsioError, std::size_t) { self->writing_ = false; });
    }

    std::shared_ptr<Stream> stream_;
    const ClientInbox& inbox_;
    boost::asio::steady_timer timer_;
    std::chrono::seconds every_;
    std::chrono::steady_clock::time_point due_{};
    std::string line_;
    bool writing_ = false, stopped_ = false;
};

class ClientLine::Impl {
public:
    ClientOutcome converse(const ClientQuestion& question, ClientInbox& inbox) {
        ClientOutcome outcome;
        const TcpAddress& where = question.address.caster;
        tcp::resolver resolver(io_);
        tcp::resolver::results_type found;
        AsioError error = wait([&](auto done) {
            resolver.async_resolve(where.host, std::to_string(where.port),
                                   [&found, done](AsioError failed, tcp::resolver::results_type results) {
                                       found = std::move(results);
                                       done(failed, 0);
                                   });
        });
        if (error)
            return outcome.problem = fmt::format("host '{}' is not known: {}", where.host, error.message()), outcome;
        if (question.address.tls) {
            auto stream = std::make_shared<TlsStream>(PlainStream(io_), tls_);
            if (!connect(*stream, found, outcome) || !shake_hands(*stream, where.host, outcome)) return outcome;
            return speak(stream, question, inbox, outcome);
        }
        auto stream = std::make_shared<PlainStream>(io_);
        if (!connect(*stream, found, outcome)) return outcome;
        return speak(stream, question, inbox, outcome);
    }

    void rest(double seconds) {
        boost::asio::steady_timer timer(io_);
        timer.expires_after(
            std::chrono::duration_cast<std::chrono::nanoseconds>(std::chrono::duration<double>(seconds)));
        wait([&](auto done) { timer.async_wait([done](AsioError error) { done(error, 0); }); });
    }

    void stop() {
        stopped_ = true;
        io_.stop();
    }
    [[nodiscard]] bool stopped() const { return stopped_; }

private:
    // Runs until what `begin` begins has ended, or until stop(). What is given to `begin` may outlive the call.
    template <class Begin>
    AsioError wait(Begin begin, std::size_t* count = nullptr) {
        struct End {
            AsioError error;
            std::size_t count = 0;
            bool come = false;
        };
        auto end = std::make_shared<End>();
        begin([end](AsioError error, std::size_t bytes) { *end = {error, bytes, true}; });
        while (!end->come && io_.run_one() > 0) {
        }
        if (count != nullptr) *count = end->count;
        return end->come ? end->error : AsioError(boost::asio::error::operation_aborted);
    }

    template <class Stream>
    bool connect(Stream& stream, const tcp::resolver::results_type& found, ClientOutcome& outcome) {
        PlainStream& plain = boost::beast::get_lowest_layer(stream);
        plain.expires_after(connect_patience);
        const AsioError error = wait([&](auto done) {
            plain.async_connect(found, [done](AsioError failed, const tcp::endpoint&) { done(failed, 0); });
        });
        if (error) return outcome.problem = "cannot be reached: " + error.message(), false;
        AsioError ignored;
        plain.socket().set_option(tcp::no_delay(true), ignored);
        plain.socket().set_option(boost::asio::socket_base::keep_alive(true), ignored);
        return outcome.connected = true;
    }

    bool shake_hands(TlsStream& stream, const std::string& host, ClientOutcome& outcome) {
        stream.set_verify_mode(ssl::verify_peer);
        stream.set_verify_callback(ssl::host_name_verification(host));
        AsioError is_name;
        boost::asio::ip::make_address(host, is_name);
        if (is_name) SSL_set_tlsext_host_name(stream.native_handle(), host.c_str());
        boost::beast::get_lowest_layer(stream).expires_after(connect_patience);
        const AsioError error = wait([&](auto done) {
            stream.async_handshake(ssl::stream_base::client, [done](AsioError failed) { done(failed, 0); });
        });
        if (!error) return true;
        outcome.connected = false;  // version 1 would not do better
        outcome.problem = "TLS: " + error.message();
        return false;
    }

    template <class Stream>
    ClientOutcome speak(const std::shared_ptr<Stream>& stream, const ClientQuestion& question, ClientInbox& inbox,
                        ClientOutcome outcome) {
        const std::string position = question.position_every.count() > 0 ? inbox.position() : std::string();
        const std::string request = ntrip_request_text(question.address, question.mount, question.version, position);
        boost::beast::get_lowest_layer(*stream).expires_after(first_bytes_patience);
        if (const AsioError error =
                wait([&](auto done) { boost::asio::async_write(*stream, boost::asio::buffer(request), done); })) {
            outcome.problem = "hung up: " + error.message();
            return outcome;
        }
        auto teller = std::make_shared<PositionTeller<Stream>>(stream, inbox, question.position_every);
        listen(*stream, question, inbox, outcome, [&] { teller->start(question.version == 2 && !position.empty()); });
        teller->stop();
        boost::beast::get_lowest_layer(*stream).close();
        return outcome;
    }

    template <class Stream, class Began>
    void listen(Stream& stream, const ClientQuestion& question, ClientInbox& inbox, ClientOutcome& outcome,
                const Began& began) {
        NtripAnswer answer;
        while (!answer.over()) {
            boost::beast::get_lowest_layer(stream).expires_after(answer.verdict() ? silence_patience
                                                                                  : first_bytes_patience);
            std::size_t count = 0;
            const AsioError error =
                wait([&](auto done) { stream.async_read_some(boost::asio::buffer(piece_), done); }, &count);
            if (error) {
                answer.finish();
                outcome.verdict = answer.verdict();
                return end(error, answer.verdict().has_value(), outcome);
            }
            const Bytes heard = answer.feed(ByteSpan(piece_).first(count));
            if (!answer.verdict()) continue;
            const bool first = !outcome.verdict;
            outcome.verdict = answer.verdict();
            const Kind kind = outcome.verdict->kind;
            if (kind == Kind::table) outcome.table.append(heard.begin(), heard.end());
            if ((kind != Kind::table && kind != Kind::stream) || outcome.table.size() > longest_table) return;
            if (kind != Kind::stream) continue;
            if (first) {
                outcome.streamed = true;
                inbox.connect(outcome.verdict->version, shown_uri(question.address));
                began();
            }
            if (heard.empty()) continue;
            outcome.brought = true;
            inbox.put(heard);
        }
        outcome.problem = "the caster has ended the stream";
    }

    static void end(const AsioError& error, bool answered, ClientOutcome& outcome) {
        if (error == boost::beast::error::timeout)
            outcome.problem = answered ? fmt::format("nothing has come for {} s", silence_patience.count())
                                       : fmt::format("no answer within {} s", first_bytes_patience.count());
        else if (error == boost::asio::error::eof || error == ssl::error::stream_truncated)
            outcome.problem = answered ? "the caster has hung up" : "the caster hung up without an answer";
        else
            outcome.problem = "the connection is lost: " + error.message();
    }

    static ssl::context make_tls() {
        ssl::context context(ssl::context::tls_client);
        AsioError ignored;  // without the system's certificates none is trusted, which the handshake tells
        context.set_default_verify_paths(ignored);
        return context;
    }

    boost::asio::io_context io_{1};
    boost::asio::executor_work_guard<boost::asio::io_context::executor_type> stays_{io_.get_executor()};
    ssl::context tls_ = make_tls();
    std::array<std::uint8_t, 8192> piece_{};
    std::atomic<bool> stopped_{false};
};

ClientLine::ClientLine() : impl_(std::make_unique<Impl>()) {}
ClientLine::~ClientLine() = default;
ClientOutcome ClientLine::converse(const ClientQuestion& question, ClientInbox& inbox) {
    return impl_->converse(question, inbox);
}
void ClientLine::rest(double seconds) { impl_->rest(seconds); }
void ClientLine::stop() { impl_->stop(); }
bool ClientLine::stopped() const { return impl_->stopped(); }

}  // namespace skyloop::inline wire
