/// How the outside world fails: a value or one clear sentence.
#pragma once

#include <string>
#include <tl/expected.hpp>
#include <utility>

namespace skyloop::inline base {

/// What a caller can act on.
enum class ErrorCode {
    usage,    ///< the user asked for something that cannot be; exit code 2
    input,    ///< a file's content is wrong; exit code 2
    outside,  ///< the outside world refused: no such file, no permission, no device; exit code 1
};

/// A failure: a code to act on and a sentence to read. `message` names file, line, column or option where there is one.
struct Error {
    ErrorCode code = ErrorCode::input;
    std::string message;
};

template <class T>
using Result = tl::expected<T, Error>;

/// An Error that converts to any Result<T>: `return fail(ErrorCode::input, "…");`
inline tl::unexpected<Error> fail(ErrorCode code, std::string message) {
    return tl::make_unexpected(Error{code, std::move(message)});
}

/// Passes an error on to a Result of another type.
inline tl::unexpected<Error> fail(Error error) { return tl::make_unexpected(std::move(error)); }

}  // namespace skyloop::inline base
