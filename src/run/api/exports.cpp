// skyloop.h: the border. Nothing but numbers and the caller's memory crosses it; no exception does.
// Structures that say their own size, in and out.

#include <fmt/format.h>

#include <algorithm>
#include <atomic>
#include <cfenv>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <exception>
#include <new>
#include <span>

#include "detail/session.hpp"

namespace skyloop::inline run {

/// Larger ones are a size that was never set.
inline constexpr std::size_t largest_struct = 4096;

/// The size that a structure has had since it exists; smaller ones are no such structure. A structure that grows keeps
/// its first size here.
template <class T>
inline constexpr std::size_t first_size = sizeof(T);

/// @param size as the caller has set it
template <class T>
Answer<void> check_size(std::size_t size, const char* name) {
    if (size >= first_size<T> && size <= largest_struct) return {};
    return refuse(SKY_E_ARG, fmt::format("{} is {}; expected {} to {}", name, size, first_size<T>, largest_struct));
}

/// The caller's structure as this version knows it: what an older caller does not know is zero, what a newer one knows
/// more is left out.
template <class T>
Answer<T> read_struct(const T* given, const char* name) {
    if (given == nullptr) return refuse(SKY_E_ARG, fmt::format("{} is null", name));
    std::uint32_t size = 0;
    std::memcpy(&size, given, sizeof size);
    if (const auto checked = check_size<T>(size, "struct_size"); !checked) return refuse(checked.error());
    T value{};
    std::memcpy(&value, given, std::min<std::size_t>(size, sizeof(T)));
    return value;
}

/// Fills the caller's structure, zeros where it is longer; its struct_size stays. check_size() comes before.
template <class T>
void write_struct(T value, T* out) {
    std::uint32_t size = 0;
    std::memcpy(&size, out, sizeof size);
    value.struct_size = size;
    std::memset(out, 0, size);
    std::memcpy(out, &value, std::min<std::size_t>(size, sizeof(T)));
}

}  // namespace skyloop::inline run

/// A handle: a run, and who is at it.
struct sky_emulator {
    std::atomic<bool> busy{false};
    sky_status broken = SKY_OK;  // what every call gives from now on
    std::string error;
    std::unique_ptr<skyloop::Session> session;
};

namespace skyloop::inline run {
namespace {

constexpr std::size_t most_told_paths = 1024;

// Holds a handle for one call, and knows when somebody else does.
class Turn {
public:
    explicit Turn(sky_emulator& emulator)
        : emulator_(emulator), mine_(!emulator.busy.exchange(true, std::memory_order_acquire)) {}
    ~Turn() {
        if (mine_) emulator_.busy.store(false, std::memory_order_release);
    }
    Turn(const Turn&) = delete;
    Turn& operator=(const Turn&) = delete;
    [[nodiscard]] bool mine() const { return mine_; }

private:
    sky_emulator& emulator_;
    bool mine_;
};

// Embree computes what traps of the floating-point unit are for, and needs none of it: a caller's must not be sprung.
// Threads that are started meanwhile have none, either.
class FloatingPointTrapsOff {
public:
    FloatingPointTrapsOff() { std::feholdexcept(&before_); }
    ~FloatingPointTrapsOff() { std::fesetenv(&before_); }
    FloatingPointTrapsOff(const FloatingPointTrapsOff&) = delete;
    FloatingPointTrapsOff& operator=(const FloatingPointTrapsOff&) = delete;

private:
    std::fenv_t before_{};
};

// The exception that is being handled, as a refusal. Memory may be short: without a sentence then.
Refusal refusal_of_exception() noexcept {
    Refusal refusal;
    try {
        throw;
    } catch (const std::bad_alloc&) {
        refusal.status = SKY_E_NOMEM;
    } catch (const std::exception& broken) {
        try {
            refusal.sentence = std::string("a mistake inside the library: ") + broken.what();
        } catch (...) {
        }
    } catch (...) {
    }
    return refusal;
}

// Calls with a session, alone at it. Whatever is thrown leaves the session half way: it is not used again.
template <class Call>
std::int64_t guarded(sky_emulator* emulator, const Call& call) noexcept {
    if (emulator == nullptr) return SKY_E_ARG;
    const Turn turn(*emulator);
    if (!turn.mine()) return SKY_E_BUSY;
    if (emulator->broken != SKY_OK) return emulator->broken;
    const FloatingPointTrapsOff quiet;
    Refusal refusal;
    try {
        Answer<std::int64_t> answer = call(*emulator->session);
        if (answer) return *answer;
        refusal = std::move(answer.error());
    } catch (...) {
        refusal = refusal_of_exception();
        emulator->broken = refusal.status;
    }
    emulator->error.swap(refusal.sentence);
    return refusal.status;
}

template <class Call>
sky_status guarded_status(sky_emulator* emulator, const Call& call) noexcept {
    return static_cast<sky_status>(guarded(emulator, [&](Session& session) -> Answer<std::int64_t> {
        const Answer<void> done = call(session);
        if (!done) return refuse(done.error());
        return SKY_OK;
    }));
}

// All of it and a zero, or nothing.
std::int64_t give_text(const std::string& text, char* buffer, std::size_t capacity) {
    if (buffer != nullptr && text.size() < capacity) std::memcpy(buffer, text.c_str(), text.size() + 1);
    return static_cast<std::int64_t>(text.size());
}

// As much as there is room for, cut at a character's end, and a zero.
void give_sentence(const std::string& sentence, char* buffer, std::uint64_t capacity) {
    if (buffer == nullptr || capacity == 0) return;
    std::size_t size = static_cast<std::size_t>(std::min<std::uint64_t>(sentence.size(), capacity - 1));
    while (size > 0 && size < sentence.size() && (static_cast<unsigned char>(sentence[size]) & 0xC0U) == 0x80)
        --size;
    std::memcpy(buffer, sentence.data(), size);
    buffer[size] = '\0';
}

Answer<sky_emulator*> created(const sky_create_info* info) {
    const auto known = read_struct(info, "info");
    if (!known) return refuse(known.error());
    auto emulator = std::make_unique<sky_emulator>();
    auto session = Session::create(*known);
    if (!session) return refuse(session.error());
    emulator->session = std::move(*session);
    return emulator.release();
}

// Where the sentence of sky_create() goes: also that of a structure which is too short, but has this much.
class ErrorRoom {
public:
    explicit ErrorRoom(const sky_create_info* info) {
        constexpr std::size_t end = offsetof(sky_create_info, error_capacity) + sizeof info->error_capacity;
        if (info == nullptr || info->struct_size < end || info->struct_size > largest_struct) return;
        buffer_ = info->error;
        capacity_ = info->error_capacity;
    }
    void clear() const {
        if (buffer_ != nullptr && capacity_ > 0) buffer_[0] = '\0';
    }
    [[nodiscard]] sky_status take(const Refusal& refusal) const {
        give_sentence(refusal.sentence, buffer_, capacity_);
        return refusal.status;
    }

private:
    char* buffer_ = nullptr;
    std::uint64_t capacity_ = 0;
};

Answer<void> check_array(const void* items, std::size_t count, const char* name) {
    if (items != nullptr || count == 0) return {};
    return refuse(SKY_E_ARG, fmt::format("{} is null; expected {} elements", name, count));
}

Answer<void> tell_paths(Session& session, std::uint32_t receiver, std::span<const std::byte> bytes,
                        std::size_t stride) {
    for (std::size_t at = 0; at < bytes.size(); at += stride) {
        sky_los los{};
        std::memcpy(&los, bytes.data() + at, std::min(stride, sizeof los));
        if (const auto told = session.tell_path(receiver, los); !told) return told;
    }
    return {};
}

}  // namespace

}  // namespace skyloop::inline run

using skyloop::Answer;
using skyloop::refuse;
using skyloop::Session;

extern "C" {

uint32_t sky_abi_version(void) { return SKY_ABI_MAJOR << 16 | SKY_ABI_MINOR; }

sky_status sky_create(const sky_create_info* info, sky_emulator** out) {
    const skyloop::ErrorRoom room(info);
    room.clear();
    if (out != nullptr) *out = nullptr;
    try {
        if (out == nullptr) return room.take({SKY_E_ARG, "out is null"});
        const skyloop::FloatingPointTrapsOff quiet;
        const auto made = skyloop::created(info);
        if (!made) return room.take(made.error());
        *out = *made;
        return SKY_OK;
    } catch (...) {
        return room.take(skyloop::refusal_of_exception());
    }
}

void sky_destroy(sky_emulator* emulator) {
    if (emulator == nullptr) return;
    emulator->busy.store(true, std::memory_order_relaxed);  // for the log function
    try {
        delete emulator;
    } catch (...) {  // what is left of it cannot be told to anybody
    }
}

sky_status sky_set_truth(sky_emulator* emulator, const sky_truth* truth) {
    return skyloop::guarded_status(emulator, [&](Session& session) -> Answer<void> {
        const auto known = skyloop::read_struct(truth, "truth");
        return known ? session.set_truth(*known) : refuse(known.error());
    });
}

sky_status sky_advance(sky_emulator* emulator, int64_t sim_time_ns, sky_progress* out) {
    return skyloop::guarded_status(emulator, [&](Session& session) -> Answer<void> {
        if (out != nullptr)
            if (const auto sized = skyloop::check_size<sky_progress>(out->struct_size, "struct_size"); !sized)
                return sized;
        Answer<void> done = session.advance(sim_time_ns);
        if (out != nullptr) skyloop::write_struct(session.progress(), out);
        return done;
    });
}

int64_t sky_read(sky_emulator* emulator, uint32_t port, void* buffer, size_t capacity) {
    return skyloop::guarded(emulator, [&](Session& session) -> Answer<std::int64_t> {
        if (const auto room = skyloop::check_array(buffer, capacity, "buffer"); !room) return refuse(room.error());
        const auto led = session.port(port);
        if (!led) return refuse(led.error());
        return static_cast<std::int64_t>((*led)->take({static_cast<std::uint8_t*>(buffer), capacity}));
    });
}

int64_t sky_write(sky_emulator* emulator, uint32_t port, const void* bytes, size_t size) {
    return skyloop::guarded(emulator, [&](Session& session) -> Answer<std::int64_t> {
        if (const auto running = session.check_running(); !running) return refuse(running.error());
        if (const auto given = skyloop::check_array(bytes, size, "bytes"); !given) return refuse(given.error());
        const auto led = session.port(port);
        if (!led) return refuse(led.error());
        return static_cast<std::int64_t>((*led)->give({static_cast<const std::uint8_t*>(bytes), size}, session.now()));
    });
}

sky_status sky_set_baud(sky_emulator* emulator, uint32_t port, uint32_t baud) {
    constexpr std::uint32_t most_baud = 50'000'000;
    return skyloop::guarded_status(emulator, [&](Session& session) -> Answer<void> {
        if (const auto running = session.check_running(); !running) return running;
        const auto led = session.port(port);
        if (!led) return refuse(led.error());
        if (baud > most_baud) return refuse(SKY_E_RANGE, fmt::format("baud is {}; expected 0 to {}", baud, most_baud));
        (*led)->set_baud(baud == 0 ? std::nullopt : std::optional(baud));
        return {};
    });
}

sky_status sky_get_fix(sky_emulator* emulator, uint32_t receiver, sky_fix* out) {
    return skyloop::guarded_status(emulator, [&](Session& session) -> Answer<void> {
        if (out == nullptr) return refuse(SKY_E_ARG, "out is null");
        if (const auto sized = skyloop::check_size<sky_fix>(out->struct_size, "struct_size"); !sized) return sized;
        const auto fix = session.fix(receiver);
        if (!fix) return refuse(fix.error());
        skyloop::write_struct(*fix, out);
        return {};
    });
}

int64_t sky_get_sats(sky_emulator* emulator, uint32_t receiver, sky_sat* out, size_t capacity, size_t stride) {
    return skyloop::guarded(emulator, [&](Session& session) -> Answer<std::int64_t> {
        if (const auto room = skyloop::check_array(out, capacity, "out"); !room) return refuse(room.error());
        if (const auto sized = skyloop::check_size<sky_sat>(stride, "stride"); !sized) return refuse(sized.error());
        const auto satellites = session.satellites(receiver);
        if (!satellites) return refuse(satellites.error());
        auto* at = reinterpret_cast<std::byte*>(out);
        for (std::size_t i = 0; i < std::min(capacity, satellites->size()); ++i, at += stride) {
            std::memset(at, 0, stride);
            std::memcpy(at, &(*satellites)[i], sizeof(sky_sat));
        }
        return static_cast<std::int64_t>(satellites->size());
    });
}

sky_status sky_set_los(sky_emulator* emulator, uint32_t receiver, const sky_los* los, size_t count, size_t stride) {
    return skyloop::guarded_status(emulator, [&](Session& session) -> Answer<void> {
        if (const auto running = session.check_running(); !running) return running;
        if (const auto there = session.check_receiver(receiver); !there) return there;
        if (const auto given = skyloop::check_array(los, count, "los"); !given) return given;
        if (const auto sized = skyloop::check_size<sky_los>(stride, "stride"); !sized) return sized;
        if (count > skyloop::most_told_paths)
            return refuse(SKY_E_ARG, fmt::format("count is {}; expected at most {}", count, skyloop::most_told_paths));
        const std::span bytes(reinterpret_cast<const std::byte*>(los), count * stride);
        return skyloop::tell_paths(session, receiver, bytes, stride);
    });
}

sky_status sky_command(sky_emulator* emulator, const char* json) {
    return skyloop::guarded_status(emulator, [&](Session& session) -> Answer<void> {
        return json != nullptr ? session.command(json) : refuse(SKY_E_ARG, "json is null");
    });
}

int64_t sky_query(sky_emulator* emulator, const char* what, char* buffer, size_t capacity) {
    return skyloop::guarded(emulator, [&](Session& session) -> Answer<std::int64_t> {
        if (what == nullptr) return refuse(SKY_E_ARG, "what is null");
        const auto text = session.query(what);
        if (!text) return refuse(text.error());
        return skyloop::give_text(*text, buffer, capacity);
    });
}

int64_t sky_last_error(sky_emulator* emulator, char* buffer, size_t capacity) {
    if (emulator == nullptr) return SKY_E_ARG;
    const skyloop::Turn turn(*emulator);
    if (!turn.mine()) return SKY_E_BUSY;
    skyloop::give_sentence(emulator->error, buffer, capacity);
    return static_cast<std::int64_t>(emulator->error.size());
}

}  // extern "C"
