/// What a board sends and answers.
#pragma once

#include <algorithm>

#include "firmware/board_profile.hpp"

namespace skyloop::firmware {

/// Whether a message can go out periodically.
inline bool sends(const BoardProfile& board, UbxMessageId message) {
    return std::find(board.messages.begin(), board.messages.end(), message) != board.messages.end();
}

/// Whether the board has a message at all: it sends or answers it.
inline bool knows(const BoardProfile& board, UbxMessageId message) {
    return board.polled.contains(message) || sends(board, message);
}

}  // namespace skyloop::firmware
