/// What an expectation needs of a receiver.
#pragma once

#include <string>

#include "run/fault/receiver_needs.hpp"
#include "run/verdict/expectation.hpp"

namespace skyloop::inline run {

/// Why a subject is never true of a receiver, whatever its client and the sky do: a phrase behind its board's name.
/// Empty: it may be.
std::string why_never_true(const SubjectClause& subject, const UsedReceiver& receiver);

}  // namespace skyloop::inline run
