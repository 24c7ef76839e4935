/// A caster's answer, read as it comes.
#pragma once

#include <memory>
#include <optional>
#include <string>

#include "base/core/bytes.hpp"

namespace skyloop::inline wire {

/// What a caster makes of a request.
struct NtripVerdict {
    enum class Kind {
        stream,         ///< what follows is what was asked for
        table,          ///< what follows is a source table: of version 1 also where there is no such mount point
        bad_password,   ///< "401 Unauthorized", "ERROR - Bad Password"
        no_such_mount,  ///< "404 Not Found"
        refused,        ///< anything else that HTTP and NTRIP have
        foreign,        ///< neither HTTP nor NTRIP
    };
    Kind kind = Kind::foreign;
    int version = 2;   ///< of NTRIP
    std::string line;  ///< the first one, as a terminal may have it
};

/// Takes the bytes of one connection. State: what has been read of the head, and where in a chunk it is.
class NtripAnswer {
public:
    NtripAnswer();
    ~NtripAnswer();
    NtripAnswer(NtripAnswer&&) noexcept;
    NtripAnswer& operator=(NtripAnswer&&) noexcept;

    /// What of `bytes` is what was asked for, without heads and the frames of chunks.
    Bytes feed(ByteSpan bytes);
    /// The caster has hung up: of a head that is not whole its first line counts, which is all that some casters say.
    void finish();
    /// Nothing until the head is there.
    [[nodiscard]] const std::optional<NtripVerdict>& verdict() const;
    /// The answer has come to its end, or to something that is none: nothing more comes of it.
    [[nodiscard]] bool over() const;

private:
    class Impl;
    std::unique_ptr<Impl> impl_;
};

}  // namespace skyloop::inline wire
