/// How a call of the C interface fails.
#pragma once

#include <cstdint>
#include <string>
#include <utility>

#include "base/core/result.hpp"
#include "skyloop.h"

namespace skyloop {

/// A status of skyloop.h, never SKY_OK, and a sentence for sky_last_error().
struct Refusal {
    sky_status status = SKY_E_INTERNAL;
    std::string sentence;
};

template <class T>
using Answer = tl::expected<T, Refusal>;

inline tl::unexpected<Refusal> refuse(sky_status status, std::string sentence) {
    return tl::make_unexpected(Refusal{status, std::move(sentence)});
}
/// What the program's own functions could not do.
inline tl::unexpected<Refusal> refuse(const Error& error) {
    return refuse(error.code == ErrorCode::outside ? SKY_E_IO : SKY_E_PARSE, error.message);
}
inline tl::unexpected<Refusal> refuse(Refusal refusal) { return tl::make_unexpected(std::move(refusal)); }

}  // namespace skyloop
