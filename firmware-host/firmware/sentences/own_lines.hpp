/// Sentences of a maker's own, by templates of the board file: "$PGRMZ,{altitude_ft:0},f,3".
///
/// In braces stand the n-th field of one of our sentences, `{GGA.9}`, as it leaves in the same epoch, or a value by
/// name with a number of decimals, `{h_acc_m:1}`. What has no value is an empty field. The checksum is added.
#pragma once

#include <string>
#include <string_view>

#include "base/core/result.hpp"
#include "firmware/core/maker.hpp"

namespace skyloop::firmware {

/// Why a template is none, in words that follow its name; nothing: it is one.
std::optional<std::string> mistake_of_own_line(std::string_view text);

/// Whether receivers of that maker send sentences, and with them a board's own lines.
bool sends_sentences(MakerKind maker);

/// Puts the board's own lines that are due among the messages of an epoch.
void add_own_lines(DueMessages& due, EpochMessages& made, PortId port);

}  // namespace skyloop::firmware
