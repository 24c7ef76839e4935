// What `skyloop decode` prints of one frame of every message, and that the frame is written again as it was read.
//
// tests/golden/listings.txt has two lines for each: the frame, of random content, in hexadecimal digits, and its
// listing. Who changes a listing on purpose puts the line there that the test prints.
#include <gtest/gtest.h>

#include <fstream>
#include <set>
#include <sstream>
#include <string>

#include "receiver/protocol/decoded_message.hpp"
#include "receiver/protocol/known_sbf.hpp"
#include "receiver/protocol/mavlink_vehicle.hpp"
#include "receiver/protocol/msp.hpp"
#include "receiver/protocol/ubx_messages.hpp"
#include "support/ubx_message_types.hpp"

namespace skyloop {
namespace {

struct KeptListing {
    Bytes frame;
    std::string text;
};

std::vector<KeptListing> kept_listings() {
    std::ifstream file(SKYLOOP_SOURCE_DIR "/tests/golden/listings.txt");
    std::vector<KeptListing> kept;
    std::string digits, text;
    while (std::getline(file, digits) && std::getline(file, text)) {
        kept.push_back({{}, text});
        for (std::size_t i = 0; i + 1 < digits.size(); i += 2)
            kept.back().frame.push_back(static_cast<std::uint8_t>(std::stoi(digits.substr(i, 2), nullptr, 16)));
    }
    return kept;
}

std::vector<StreamPiece> pieces_of(const Bytes& frame) {
    StreamSplitter splitter(StreamProtocols{.msp = true, .mavlink = true, .sbf = true});
    std::vector<StreamPiece> pieces = splitter.feed(frame);
    for (StreamPiece& piece : splitter.finish())
        pieces.push_back(std::move(piece));
    return pieces;
}

TEST(Listings, AreAsTheyWere) {
    for (const KeptListing& kept : kept_listings()) {
        const auto pieces = pieces_of(kept.frame);
        ASSERT_EQ(pieces.size(), 1u) << kept.text;
        EXPECT_EQ(text_line(decode_piece(pieces.front())), kept.text);
        if (pieces.front().kind != StreamKind::ubx) continue;
        const auto frame = *parse_frame(kept.frame);
        auto again = UbxOutputTypes::written_again(frame);
        if (!again) again = UbxSettingTypes::written_again(frame);
        EXPECT_EQ(again, kept.frame) << kept.text;
    }
}

TEST(Listings, HaveEveryMessage) {
    std::set<std::string> names;
    for (const KeptListing& kept : kept_listings()) {
        std::istringstream words(kept.text);
        std::string protocol, name;
        words >> protocol >> name;
        names.insert(name);
    }
    for (const UbxMessage& message : ubx_messages()) {
        const bool has_no_layout = message.list == nullptr;
        EXPECT_TRUE(has_no_layout || names.contains(std::string(message.name))) << message.name;
    }
    const auto is_there = [&]<class Message>() {
        EXPECT_TRUE(names.contains(std::string(Message::message_name))) << Message::message_name;
        return false;
    };
    KnownSbfBlocks::any(is_there);
    KnownMavlinkMessages::any(is_there);
    MessageTypes<MspSensorGps, MspSetRawGps>::any(is_there);
}

}  // namespace
}  // namespace skyloop
