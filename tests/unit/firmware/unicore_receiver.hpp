/// A Unicore receiver with clients at its three ports, and what leaves it.
#pragma once

#include <gtest/gtest.h>

#include <chrono>
#include <cstddef>
#include <cstdint>
#include <map>
#include <string>
#include <vector>

#include "firmware/core/receiver.hpp"
#include "support/receiver_rig.hpp"

namespace skyloop::firmware {

/// A line of text, without its end, and when its last byte had left.
struct UnicoreLine {
    std::string text;
    GpsTime at;
};

class UnicoreReceiver : public testing::Test {
protected:
    explicit UnicoreReceiver(const std::string& board = "unicore-um982")
        : receiver_(test::board_named(board), ReceiverOptions{}) {
        receiver_.start(now_);
    }

    // Runs for so long, an epoch each period of the receiver; lines and bytes of the ports are kept.
    void wait(Nanoseconds length) {
        for (const GpsTime end = now_ + length; now_ < end;) {
            now_ += std::chrono::milliseconds(1);
            for (const Receiver::Sent& sent : receiver_.output(now_))
                keep(sent);
            if (now_.time_since_epoch() % receiver_.settings().navigation_period != Nanoseconds(0)) continue;
            Epoch epoch = epoch_;
            epoch.fix.time = now_;
            if (!epoch.observations.signals.empty()) epoch.observations.receive_time = now_;
            receiver_.on_epoch(epoch);
        }
    }
    void say(const std::string& line, PortId port = PortId::uart1) {
        receiver_.input(port, to_bytes(line + "\r\n"), now_);
    }
    // What comes within 200 ms of a command, by the same port.
    std::vector<std::string> answers(const std::string& line, PortId port = PortId::uart1) {
        lines_[port].clear();
        say(line, port);
        wait(std::chrono::milliseconds(200));
        return texts(port);
    }
    std::vector<std::string> texts(PortId port = PortId::uart1) {
        std::vector<std::string> found;
        for (const UnicoreLine& line : lines_[port])
            found.push_back(line.text);
        return found;
    }
    // Those that begin so.
    std::vector<UnicoreLine> lines(const std::string& begin, PortId port = PortId::uart1) {
        std::vector<UnicoreLine> found;
        for (const UnicoreLine& line : lines_[port])
            if (line.text.starts_with(begin)) found.push_back(line);
        return found;
    }
    // One second of the sentences that most receivers send.
    std::vector<std::string> usual_sentences() {
        for (const char* const log : {"GPRMC 1", "GPGGA 1", "GPGSA 1", "GPGSV 1", "GPVTG 1", "GPGLL 1"})
            say(log);
        wait(std::chrono::seconds(1));
        forget();
        wait(std::chrono::seconds(1));
        return texts();
    }
    void forget() {
        lines_.clear();
        bytes_.clear();
    }

    static std::string with_sum(const std::string& answer, std::size_t from) {
        unsigned sum = 0;
        for (std::size_t i = from; i < answer.size(); ++i)
            sum ^= static_cast<unsigned char>(answer[i]);
        constexpr char digits[] = "0123456789ABCDEF";
        return answer + '*' + digits[sum >> 4] + digits[sum & 15];
    }
    // Of an answer the sum covers the dollar.
    static std::string answer_line(const std::string& text) { return with_sum(text, 0); }
    static std::string ok_to(const std::string& command) {
        return answer_line("$command," + command + ",response: OK");
    }
    static std::string refusal_of(const std::string& command, const std::string& name) {
        return answer_line("$command," + command + ",response: PARSING FAILD NO MATCHING FUNC  " + name);
    }

    // CRC-32 from the highest bit of the reversed polynomial down, by polynomial division of the reflected bits.
    static std::uint32_t own_crc(const std::uint8_t* bytes, std::size_t size) {
        std::uint32_t crc = 0;
        for (std::size_t i = 0; i < 8 * size; ++i) {
            const std::uint32_t bit = bytes[i / 8] >> i % 8 & 1u;
            const bool turn = ((crc ^ bit) & 1u) != 0;
            crc >>= 1;
            if (turn) crc ^= 0xEDB88320u;
        }
        return crc;
    }

    // The fields of a log's body, its CRC having been checked.
    static std::vector<std::string> body_fields(const std::string& line) {
        const std::size_t star = line.rfind('*'), body = line.find(';');
        EXPECT_NE(body, std::string::npos) << line;
        const std::string covered = line.substr(1, star - 1);
        EXPECT_EQ(own_crc(reinterpret_cast<const std::uint8_t*>(covered.data()), covered.size()),
                  std::stoul(line.substr(star + 1), nullptr, 16))
            << line;
        std::vector<std::string> fields(1);
        for (const char c : line.substr(body + 1, star - body - 1))
            c == ',' ? fields.emplace_back() : fields.back() += c;
        return fields;
    }

    Receiver receiver_;
    Epoch epoch_{test::driving_fix({})};
    GpsTime now_ = to_gps_time(*parse_utc("2024-03-05T12:00:00Z"), LeapSeconds::announced());
    std::map<PortId, std::vector<UnicoreLine>> lines_;
    std::map<PortId, Bytes> bytes_;

private:
    void keep(const Receiver::Sent& sent) {
        Bytes& all = bytes_[sent.port];
        all.insert(all.end(), sent.bytes.begin(), sent.bytes.end());
        std::string& begun = begun_[sent.port];
        for (const std::uint8_t byte : sent.bytes) {
            if (byte == '\n') {
                if (begun.ends_with('\r')) begun.pop_back();
                lines_[sent.port].push_back({begun, now_});
                begun.clear();
            } else {
                begun += static_cast<char>(byte);
            }
        }
    }
    std::map<PortId, std::string> begun_;
};

}  // namespace skyloop::firmware
