#include "detail/caster_session.hpp"

#include <algorithm>
#include <array>
#include <boost/asio/write.hpp>
#include <boost/beast/core.hpp>
#include <chrono>
#include <optional>
#include <utility>

#include "wire/ntrip/ntrip_messages.hpp"
#include "wire/ntrip/source_table.hpp"

namespace skyloop::inline wire {
namespace {

using AsioError = boost::system::error_code;

constexpr std::chrono::seconds request_patience{10}, answer_patience{5};
constexpr std::size_t longest_line = 512, most_drained_bytes = 65536;
constexpr int kernel_bytes = 65536;  // that wait for a slow reader beside those that are counted

}  // namespace

// A connection from its first byte to its last. Handlers keep it alive; it is over when none is left.
class CasterSession : public std::enable_shared_from_this<CasterSession> {
public:
    CasterSession(CasterCore& core, boost::asio::ip::tcp::socket socket) : core_(core), stream_(std::move(socket)) {
        ++core_.asking;
    }
    CasterSession(const CasterSession&) = delete;
    CasterSession& operator=(const CasterSession&) = delete;
    ~CasterSession() { leave(); }

    void start() {
        AsioError ignored;
        stream_.socket().set_option(boost::asio::ip::tcp::no_delay(true), ignored);
        stream_.socket().set_option(boost::asio::socket_base::keep_alive(true), ignored);
        stream_.socket().set_option(boost::asio::socket_base::send_buffer_size(kernel_bytes), ignored);
        deadline_ = std::chrono::steady_clock::now() + request_patience;
        read_head();
    }

    void pump() {
        const Bytes bytes = corrections_->take();
        if (bytes.empty()) return;
        const std::string_view text(reinterpret_cast<const char*>(bytes.data()), bytes.size());
        if (waiting_.size() + text.size() > NtripCaster::most_waiting_bytes) {
            ++core_.slow;
            return close();
        }
        core_.bytes += bytes.size();
        waiting_ += chunked_ ? ntrip_chunk(text) : std::string(text);
        flush();
    }

private:
    // Of those that ask, or of those that hear corrections.
    void leave() {
        if (corrections_) {
            if (core_.streaming.erase(this) > 0) --core_.clients;
        } else if (!std::exchange(left_, true)) {
            --core_.asking;
            if (core_.make_room) core_.make_room();
        }
    }

    void close() {
        AsioError ignored;
        stream_.socket().close(ignored);
        if (corrections_) leave();
    }

    // The whole head has to be there by the deadline, however slowly it trickles.
    void read_head() {
        stream_.expires_at(deadline_);
        stream_.async_read_some(boost::asio::buffer(piece_),
                                [self = shared_from_this()](AsioError error, std::size_t count) {
                                    if (!error) return self->take_head(count);
                                    ++self->core_.refused;
                                });
    }

    void take_head(std::size_t count) {
        constexpr std::string_view end_of_head = "\r\n\r\n";
        heard_.append(piece_.data(), count);
        const std::size_t end = heard_.find(end_of_head);
        if (end != std::string::npos && end <= longest_ntrip_head) {
            const std::string head = heard_.substr(0, end + end_of_head.size());
            heard_.erase(0, head.size());
            return answer(parse_ntrip_request(head));
        }
        if (heard_.size() > longest_ntrip_head)
            return refuse(ntrip_refusal(431, "Request Header Fields Too Large", "the request is too long"));
        read_head();
    }

    void answer(const std::optional<NtripRequest>& request) {
        if (!request) return refuse(ntrip_refusal(400, "Bad Request", "expected GET /MOUNT HTTP/1.1"));
        if (request->method != "GET") return refuse(ntrip_refusal(405, "Method Not Allowed", "expected GET"));
        if (request->mount.empty()) return finish(ntrip_table_answer(*request, core_.table()));
        const auto mount = core_.settings.mounts.find(request->mount);
        if (mount == core_.settings.mounts.end()) return refuse(ntrip_missing_answer(*request, core_.table()));
        if (!is_allowed(*request)) return refuse(ntrip_password_answer(*request));
        const bool full = core_.streaming.size() >= static_cast<std::size_t>(NtripCaster::most_clients);
        auto corrections = full ? nullptr : mount->second->open();
        if (!corrections) return refuse(ntrip_refusal(503, "Service Unavailable", "too many clients"));
        stream(*request, std::move(corrections));
    }

    // Who names a user that there is not waits as long as who names one.
    [[nodiscard]] bool is_allowed(const NtripRequest& request) const {
        const auto& users = core_.settings.users;
        if (users.empty()) return true;
        const auto user = users.find(request.user);
        const bool known = user != users.end();
        return same_password(request.password, known ? user->second : users.begin()->second) && known;
    }

    void refuse(std::string text) {
        ++core_.refused;
        finish(std::move(text));
    }

    // A close with bytes unread resets the connection, and the client would not see the answer.
    void finish(std::string text) {
        writing_ = std::move(text);
        stream_.expires_after(answer_patience);
        boost::asio::async_write(
            stream_, boost::asio::buffer(writing_), [self = shared_from_this()](AsioError error, std::size_t) {
                if (error) return;
                AsioError ignored;
                self->stream_.socket().shutdown(boost::asio::ip::tcp::socket::shutdown_send, ignored);
                self->stream_.expires_after(answer_patience);
                self->drain(0);
            });
    }

    void drain(std::size_t drained) {
        if (drained > most_drained_bytes) return;
        stream_.async_read_some(boost::asio::buffer(piece_),
                                [self = shared_from_this(), drained](AsioError error, std::size_t count) {
                                    if (!error) self->drain(drained + count);
                                });
    }

    void stream(const NtripRequest& request, std::unique_ptr<CorrectionsStream> corrections) {
        leave();
        corrections_ = std::move(corrections);
        chunked_ = request.chunked;
        core_.streaming.insert(this);
        ++core_.clients;
        ++core_.served;
        stream_.expires_never();
        if (is_position_sentence(request.gga)) corrections_->hear_position(request.gga);
        take_lines();
        waiting_ = ntrip_stream_answer(request);
        flush();
        read_lines();
    }

    void flush() {
        if (waiting_.empty() || is_writing_) return;
        is_writing_ = true;
        writing_ = std::exchange(waiting_, {});
        boost::asio::async_write(stream_, boost::asio::buffer(writing_),
                                 [self = shared_from_this()](AsioError error, std::size_t) {
                                     self->is_writing_ = false;
                                     if (error) return self->close();
                                     self->flush();
                                 });
    }

    void read_lines() {
        stream_.async_read_some(boost::asio::buffer(piece_),
                                [self = shared_from_this()](AsioError error, std::size_t count) {
                                    if (error) return self->close();
                                    self->heard_.append(self->piece_.data(), count);
                                    self->take_lines();
                                    self->read_lines();
                                });
    }

    // Sentences may come in chunks, too: their frames are lines that are none.
    void take_lines() {
        for (std::size_t end = heard_.find('\n'); end != std::string::npos; end = heard_.find('\n')) {
            std::string line = heard_.substr(0, end);
            heard_.erase(0, end + 1);
            if (line.ends_with('\r')) line.pop_back();
            if (is_position_sentence(line)) corrections_->hear_position(line);
        }
        if (heard_.size() > longest_line) heard_.clear();
    }

    CasterCore& core_;
    boost::beast::tcp_stream stream_;
    std::chrono::steady_clock::time_point deadline_{};
    std::unique_ptr<CorrectionsStream> corrections_;  // null: it asks
    std::array<char, 2048> piece_{};
    std::string heard_, waiting_, writing_;
    bool is_writing_ = false, chunked_ = false, left_ = false;
};

std::string CasterCore::table() const {
    std::vector<std::string> lines;
    for (const auto& [name, source] : settings.mounts)
        lines.push_back(source->table_line(!settings.users.empty()));
    return source_table(lines);
}

void serve_ntrip(CasterCore& core, boost::asio::ip::tcp::socket socket) {
    std::make_shared<CasterSession>(core, std::move(socket))->start();
}

// One that is dropped meanwhile leaves the set.
void pump_ntrip(CasterCore& core) {
    const std::set<CasterSession*> streaming = core.streaming;
    for (CasterSession* session : streaming)
        session->pump();
}

}  // namespace skyloop::inline wire
