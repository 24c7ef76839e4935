#include "receiver/protocol/patient_splitter.hpp"

#include <algorithm>

namespace skyloop {
namespace {

using namespace std::chrono_literals;

// A beginning that goes on no further is false: a client waits for its answer. So is one that goes on for longer than
// the longest settings take at 9600 baud: clients that never pause must not wait for 8192 bytes, nor those that poll
// more often than every silence.
constexpr Nanoseconds silence_of_false_beginning = 100ms, longest_of_false_beginning = 1s;

}  // namespace

std::vector<StreamPiece> PatientSplitter::feed(ByteSpan bytes, GpsTime now) {
    std::vector<StreamPiece> pieces = splitter_.feed(bytes);
    gives_way_at_.reset();
    if (!splitter_.holds_whole()) {
        held_since_.reset();
        return pieces;
    }
    if (!held_since_) held_since_ = now;
    gives_way_at_ = std::min(now + silence_of_false_beginning, *held_since_ + longest_of_false_beginning);
    return pieces;
}

std::vector<StreamPiece> PatientSplitter::give_way() {
    held_since_.reset();
    gives_way_at_.reset();
    return splitter_.give_way();
}

std::vector<StreamPiece> PatientSplitter::finish() {
    held_since_.reset();
    gives_way_at_.reset();
    return splitter_.finish();
}

}  // namespace skyloop
