// Whatever is wrong with a wire, and whatever hangs on its other end, simulated time goes on.
#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "run/client/open_client.hpp"
#include "run/fault/fault_kind.hpp"
#include "support/run_parts.hpp"
#include "unit/transport/temporary_folder.hpp"

namespace skyloop::test {
namespace {

// Never waits, and ends a run whose time stands still.
class WatchfulPacer : public Pacer {
public:
    explicit WatchfulPacer(std::atomic<bool>& stop) : stop_(stop) {}
    std::optional<Nanoseconds> wait_until(GpsTime time) override {
        looks_ = time == last_ ? looks_ + 1 : 0;
        last_ = time;
        if (looks_ > most_looks) stop_ = true;
        return Nanoseconds(0);
    }
    [[nodiscard]] Nanoseconds tick(bool) const override { return Nanoseconds(0); }
    [[nodiscard]] std::int64_t monotonic_ns(GpsTime now) const override { return now.time_since_epoch().count(); }

private:
    static constexpr int most_looks = 1000;  // at one instant
    std::atomic<bool>& stop_;
    GpsTime last_{};
    int looks_ = 0;
};

enum class OtherEnd { nothing, memory, client };

std::unique_ptr<Transport> other_end(OtherEnd end) {
    if (end == OtherEnd::memory) return std::make_unique<MemoryTransport>();
    auto client = open_client("careful-ubx");
    EXPECT_TRUE(client);
    return std::move(*client);
}

Scenario faulty_scenario(const std::string& faults) {
    return emulator_scenario(
        "[run]\nstart = 2024-03-05T12:00:00Z\n[model]\nname = \"ideal\"\n[[receiver]]\nboard = \"ublox-m8\"\n" +
        faults);
}

std::string wire_fault_text(std::string_view kind, std::string_view direction) {
    std::string text = "[[fault]]\nkind = \"" + std::string(kind) + "\"\nat_s = 1.2\nfor_s = 2.5\n";
    if (!direction.empty()) text += "direction = \"" + std::string(direction) + "\"\n";
    if (kind == "inserted_garbage") text += "bursts_per_s = 5\n";
    return text;
}

// A run of six seconds; how far it comes, s.
double seconds_run(const std::string& faults, OtherEnd end, std::optional<Recorder> recorder = std::nullopt) {
    const Scenario scenario = faulty_scenario(faults);
    const GpsTime start = scenario.run.start.value();
    Station::Parts parts = station_parts(scenario, 0, start);
    parts.recorder = std::move(recorder);
    const auto port = firmware::PortId::uart1;
    if (end != OtherEnd::nothing) parts.wires.push_back({port, Link(other_end(end), port_speed(parts.receiver, port))});
    std::vector<Station> stations;
    stations.emplace_back(std::move(parts));
    std::atomic<bool> stop{false};
    Emulator emulator({std::move(stations), std::make_unique<WatchfulPacer>(stop)}, start);
    Director::Parts director;
    director.faults = scenario.faults;
    director.start = start;
    emulator.replace_director(Director(std::move(director)));
    emulator.run_until(advanced(start, Seconds(6)), stop);
    return difference(emulator.now(), start).value();
}

std::vector<const FaultKind*> wire_kinds() {
    std::vector<const FaultKind*> kinds;
    for (const FaultKind& kind : fault_kinds())
        if (kind.layer == FaultLayer::wire) kinds.push_back(&kind);
    return kinds;
}

// The ways that a fault can go; an empty word where it has none.
std::span<const std::string_view> directions_of(const FaultKind& kind) {
    static constexpr std::string_view none[] = {""};
    for (const ParameterSpec& parameter : kind.parameters)
        if (parameter.name == "direction") return parameter.choices;
    return none;
}

TEST(WireFaultsEnd, AtEveryOtherEndInEveryDirection) {
    for (const FaultKind* kind : wire_kinds())
        for (const std::string_view direction : directions_of(*kind))
            for (const OtherEnd end : {OtherEnd::nothing, OtherEnd::memory, OtherEnd::client})
                EXPECT_EQ(seconds_run(wire_fault_text(kind->name, direction), end), 6)
                    << kind->name << ' ' << direction << ' ' << static_cast<int>(end);
}

TEST(WireFaultsEnd, AlsoTwoAtATime) {
    const auto kinds = wire_kinds();
    for (std::size_t i = 0; i < kinds.size(); ++i)
        for (std::size_t k = 0; k < i; ++k) {
            const auto text = [&](const FaultKind* kind) {
                return wire_fault_text(kind->name, directions_of(*kind).back());
            };
            EXPECT_EQ(seconds_run(text(kinds[i]) + text(kinds[k]), OtherEnd::nothing), 6)
                << kinds[i]->name << " and " << kinds[k]->name;
        }
}

// Every burst at its time, not all of them when the fault is over.
TEST(WireFaultsEnd, GarbageReachesTheReceiverInBursts) {
    for (const OtherEnd end : {OtherEnd::nothing, OtherEnd::memory, OtherEnd::client}) {
        const TemporaryFolder folder;
        auto recorder = test::recorder_in(folder.path(), 1);
        ASSERT_TRUE(recorder);
        const std::string fault =
            "[[fault]]\nkind = \"inserted_garbage\"\nat_s = 1.2\nfor_s = 4\nbursts_per_s = 5\n"
            "direction = \"to_receiver\"\n";
        EXPECT_EQ(seconds_run(fault, end, std::move(*recorder)), 6);
        int bursts = 0;
        for (const std::string& line : lines_of(content_of(folder.path() / "port0.in_times")))
            bursts += line.ends_with(" 16") ? 1 : 0;
        EXPECT_GE(bursts, 8) << static_cast<int>(end);
    }
}

}  // namespace
}  // namespace skyloop::test
