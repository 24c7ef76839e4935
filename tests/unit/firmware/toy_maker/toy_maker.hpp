/// A maker that nobody knows: what it takes to add one. $PTOY,RATE,200 sets the period; each epoch is one $PTOY,FIX.
#pragma once

#include <fmt/format.h>

#include <memory>
#include <string>

#include "base/core/number_text.hpp"
#include "firmware/core/factory_settings.hpp"
#include "firmware/core/maker.hpp"
#include "receiver/protocol/nmea_sentence.hpp"

namespace skyloop::firmware {

class ToyMaker : public Maker {
public:
    ToyMaker(const BoardProfile& board, const ReceiverOptions& options)
        : Maker(board), factory_(factory_settings(board, options)), now_(factory_) {}

    [[nodiscard]] const ReceiverConfig& config() const override { return now_; }
    [[nodiscard]] std::uint64_t revision() const override { return revision_; }

    CommandOutcome receive(const StreamPiece& piece, const Situation&) override {
        const std::string text = to_string(piece.bytes);
        const auto sentence = parse_sentence(text);
        if (piece.kind != StreamKind::nmea || !sentence || sentence->address != "PTOY") return {};
        const auto period_ms = number_in<int>(sentence->field(1));
        if (sentence->field(0) != "RATE" || !period_ms || *period_ms < 1) return answer("PTOY,NO");
        ++revision_;
        set_navigation_period(now_.settings, feasible_period(std::chrono::milliseconds(*period_ms), 1, board()),
                              board());
        return answer("PTOY,OK");
    }
    DueMessages due(PortId port, EpochMessages& made, const FirmwareFaults&) override {
        DueMessages due;
        const Fix& fix = made.state().epoch.fix;
        if (port == PortId::uart1)
            due.add({to_bytes(Sentence(fmt::format("PTOY,FIX,{}", fix.satellites_used())).finish())});
        return due;
    }
    void restart(bool) override { forget_settings(); }
    void lose_battery() override {}
    void forget_settings() override { ++revision_, now_ = factory_; }
    void set_speed(std::uint32_t baud) override { ++revision_, now_.ports[1].baud = baud; }
    [[nodiscard]] bool takes_speed(std::uint32_t baud) const override { return takes_baud(board(), baud); }
    [[nodiscard]] std::string stored_text() const override { return {}; }
    Result<void> restore(const std::string&, const std::string&) override { return {}; }

private:
    static CommandOutcome answer(const char* body) {
        CommandOutcome outcome;
        outcome.answers.push_back(to_bytes(Sentence(body).finish()));
        return outcome;
    }
    ReceiverConfig factory_, now_;
    std::uint64_t revision_ = 1;
};

inline constexpr MakerRow toy_row{"toy",
                                  [](const BoardProfile& board, const ReceiverOptions& options) {
                                      return std::unique_ptr<Maker>(std::make_unique<ToyMaker>(board, options));
                                  },
                                  [](const BoardProfile&) { return Abilities{.own_prefix = "PTOY"}; }};

}  // namespace skyloop::firmware
