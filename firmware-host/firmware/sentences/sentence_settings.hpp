/// What receivers of sentences can be set to, whoever made them.
#pragma once

#include <deque>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "firmware/core/factory_settings.hpp"
#include "firmware/core/layered_values.hpp"

namespace skyloop::firmware {

/// A setting that receivers of one maker have besides.
struct OwnSetting {
    std::uint32_t key = 0;  ///< 5000 and up, or of one that all have, whose factory value differs
    std::string_view name;
    std::uint64_t factory = 0;
};
/// A list of them that a board makes, and the names that it points to.
struct OwnSettings {
    std::deque<std::string> names;
    std::vector<OwnSetting> list;

    void add(std::uint32_t key, std::string name, std::uint64_t factory) {
        list.push_back({key, names.emplace_back(std::move(name)), factory});
    }
};

/// A board's UARTs in their order, by which commands number them.
std::vector<PortId> uarts_of(const BoardProfile& board);
/// Whether the board is fast enough for a fix each so many milliseconds.
bool can_fix_each(const BoardProfile& board, std::uint64_t period_ms);

/// Settings by our own names, "fix_interval_ms" or "GGA_uart1".
class SentenceSettings : public LayeredValues {
public:
    /// @param board it must outlive this
    SentenceSettings(const BoardProfile& board, const ReceiverOptions& options, std::span<const OwnSetting> own = {});

    static constexpr std::uint32_t fix_interval_ms = 1, dynamic_model = 2, held_below_cmps = 3, sbas_corrections = 4;
    static constexpr std::uint32_t baud(PortId port) { return 10 + static_cast<std::uint32_t>(port); }
    static constexpr std::uint32_t rtcm_in(PortId port) { return 20 + static_cast<std::uint32_t>(port); }
    static constexpr std::uint32_t system(Constellation c) { return 30 + static_cast<std::uint32_t>(c); }
    /// Every how many epochs a port sends a sentence, "GGA"; nothing for a name that stands for none.
    [[nodiscard]] static std::optional<std::uint32_t> rate(std::string_view sentence, PortId port);
    [[nodiscard]] static std::uint32_t rate(std::size_t sentence, PortId port) {
        return 100 + static_cast<std::uint32_t>(sentence * port_count) + static_cast<std::uint32_t>(port);
    }

    /// Whether the board could go on with these systems on: it has them, and one of them gives a position.
    [[nodiscard]] bool can_have(const std::vector<std::pair<Constellation, bool>>& wanted) const;
    /// The value is in flash from then on; one of the factory needs no flash.
    void keep(std::uint32_t key, std::uint64_t value);
    /// What the receiver does by them.
    [[nodiscard]] ReceiverConfig config() const;

protected:
    [[nodiscard]] std::string name_of(std::uint32_t key) const override;
    [[nodiscard]] std::optional<std::uint32_t> key_of(std::string_view name) const override;
    [[nodiscard]] std::uint64_t cut(std::uint32_t, std::uint64_t value) const override { return value & 0xFFFF'FFFFu; }
    [[nodiscard]] std::size_t bytes_of(std::uint32_t) const override { return 4; }

private:
    void put_systems(ReceiverConfig& config) const;

    const BoardProfile& board_;
    ReceiverConfig factory_;
    std::map<std::uint32_t, std::string> names_;
};

}  // namespace skyloop::firmware
