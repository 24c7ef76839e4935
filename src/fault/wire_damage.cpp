#include "skyloop/fault/wire_damage.hpp"

#include <utility>

namespace skyloop {

class WireDamage::State {
public:
    Bytes passing;
};

WireDamage::WireDamage(std::uint64_t, std::string_view) : state_(std::make_unique<State>()) {}
WireDamage::~WireDamage() = default;
WireDamage::WireDamage(WireDamage&&) noexcept = default;
WireDamage& WireDamage::operator=(WireDamage&&) noexcept = default;

void WireDamage::set(const WireDirection&, GpsTime) {}

void WireDamage::put(ByteSpan bytes, GpsTime) {
    state_->passing.insert(state_->passing.end(), bytes.begin(), bytes.end());
}

Bytes WireDamage::take(GpsTime) { return std::exchange(state_->passing, {}); }

std::optional<GpsTime> WireDamage::next_at() const { return std::nullopt; }

std::size_t WireDamage::waiting() const { return 0; }

}  // namespace skyloop
