/// A receiver reduced to what its sentences are made from.
#pragma once

#include <gtest/gtest.h>

#include <algorithm>
#include <string>
#include <variant>
#include <vector>

#include "firmware/messages/make_message.hpp"
#include "firmware/ublox/config/config_handler.hpp"
#include "receiver/protocol/nmea_messages.hpp"
#include "sample_epochs.hpp"

namespace skyloop::firmware {

/// Board, configuration and state; time and date are known from the first kind of fix on.
struct SampleReceiver {
    explicit SampleReceiver(BoardProfile profile) : board(std::move(profile)), config(factory_config(board)) {
        state.time.leap_seconds = true;
    }

    /// Takes a fix as the state tracker would that limits and holds nothing.
    void set(const Fix& fix) {
        state.epoch.fix = fix;
        state.fix_ok = fix.has_position();
        state.position_known = state.position_known || fix.has_position();
        if (fix.type != FixType::none) state.time.time = state.time.date = true;
        state.course = fix.has_position() ? std::optional(fix.course) : std::nullopt;
        state.course_is_frozen = fix.speed < board.course_min_speed;
    }
    /// What it holds is that of the last call.
    [[nodiscard]] ReportContext context() const {
        in_force = receiver_config(config, board);
        return {board, in_force, state};
    }
    /// One message, as text.
    [[nodiscard]] std::vector<std::string> message(std::uint8_t id, std::uint8_t message_class = 0xF0) const {
        std::vector<std::string> lines;
        for (const Bytes& bytes : make_message({message_class, id}, context()))
            lines.push_back(to_string(bytes));
        return lines;
    }
    /// A message of one sentence.
    [[nodiscard]] std::string line(std::uint8_t id, std::uint8_t message_class = 0xF0) const {
        const auto lines = message(id, message_class);
        EXPECT_EQ(lines.size(), 1U);
        return lines.empty() ? std::string() : lines.front();
    }
    /// What the board sends of an epoch.
    [[nodiscard]] std::vector<std::string> sentences() const {
        std::vector<std::string> lines;
        for (const SentenceRate& rate : board.sentences) {
            const auto name = nmea_sentence_names[static_cast<std::size_t>(rate.sentence)];
            for (std::string& one : message(find_output_message(name)->id.id))
                lines.push_back(std::move(one));
        }
        return lines;
    }
    std::vector<std::string> sentences(const Fix& fix) {
        set(fix);
        return sentences();
    }
    [[nodiscard]] int rate(std::string_view name, PortId port = PortId::uart1) const {
        return config.rate(find_output_message(name)->id, port);
    }

    BoardProfile board;
    ConfigStore config;
    NavigationState state;
    mutable ReceiverConfig in_force;
};

/// The messages of one kind among sentences.
template <class Message>
std::vector<Message> messages_of_kind(const std::vector<std::string>& sentences) {
    std::vector<Message> out;
    for (const auto& s : sentences) {
        const auto message = decode_nmea(s);
        EXPECT_TRUE(message) << s;
        if (message && std::holds_alternative<Message>(*message)) out.push_back(std::get<Message>(*message));
    }
    return out;
}

}  // namespace skyloop::firmware
