/// What it costs to make UBX messages, against copying their bytes.
#include <benchmark/benchmark.h>

#include "firmware/messages/make_message.hpp"
#include "firmware/ublox/config/config_handler.hpp"
#include "receiver/protocol/ubx_nav.hpp"
#include "receiver/protocol/ubx_satellites.hpp"

namespace {

using namespace skyloop;
using namespace skyloop::firmware;

// A dual-frequency receiver with `count` used satellites on two signals each.
struct BusyReceiver {
    explicit BusyReceiver(int count) : config(factory_config(board)) {
        board.identity.generation = 9;
        board.dual_frequency = true;
        Fix& fix = state.epoch.fix;
        fix.type = FixType::fix_3d;
        fix.position = Geodetic::degrees(47.1, 8.7, 512);
        fix.dop = {2.41, 2.02, 1.1, 1.69, 1.31, 0.66, 0.88};
        state.fix_ok = state.ever_had_fix = state.position_known = true;
        state.time = {true, true, true, true, Seconds(25e-9)};
        for (int i = 0; i < count; ++i) {
            const SatelliteId id{i % 2 == 0 ? Constellation::gps : Constellation::galileo, 1 + i / 2};
            fix.satellites.push_back({id, Angle::degrees(9.0 * i), Angle::degrees(10 + i), DbHz(41), true});
            for (const Signal signal : {Signal::l1, i % 2 == 0 ? Signal::l2 : Signal::e5b}) {
                Observation o;
                o.satellite = id;
                o.signal = signal;
                o.carrier = carrier_frequency(signal);
                o.cn0 = DbHz(41);
                o.pseudorange = Metres(22e6);
                o.carrier_phase = 1.1e8;
                o.doppler = Hertz(1234);
                state.epoch.observations.signals.push_back(o);
            }
        }
    }
    [[nodiscard]] ReportContext context() const { return {board, in_force, state, {}, PortId::uart1}; }

    BoardProfile board;
    ConfigStore config;
    NavigationState state;
    ReceiverConfig in_force{receiver_config(config, board)};
};

// NAV-PVT, NAV-SAT, NAV-SIG and RXM-RAWX of one epoch.
std::size_t make_epoch(const ReportContext& context) {
    std::size_t bytes = 0;
    for (const Bytes& frame : make_navigation_message(NavPvt::message_id, context))
        bytes += frame.size();
    for (const UbxMessageId id : {NavSat::message_id, NavSig::message_id})
        for (const Bytes& frame : make_satellite_message(id, context))
            bytes += frame.size();
    for (const Bytes& frame : make_raw_message(RxmRawx::message_id, context))
        bytes += frame.size();
    return bytes;
}

void epoch_of_forty_satellites(benchmark::State& state) {
    const BusyReceiver receiver(40);
    std::size_t bytes = 0;
    for (auto _ : state)
        bytes = make_epoch(receiver.context());
    state.SetBytesProcessed(static_cast<std::int64_t>(bytes) * state.iterations());
    state.counters["bytes"] = static_cast<double>(bytes);
}
BENCHMARK(epoch_of_forty_satellites)->Unit(benchmark::kMicrosecond);

// The least that any maker of those bytes must do.
void copy_of_such_an_epoch(benchmark::State& state) {
    const Bytes source(make_epoch(BusyReceiver(40).context()), 0x55);
    for (auto _ : state)
        benchmark::DoNotOptimize(Bytes(source));
    state.SetBytesProcessed(static_cast<std::int64_t>(source.size()) * state.iterations());
}
BENCHMARK(copy_of_such_an_epoch)->Unit(benchmark::kMicrosecond);

template <class Message>
void write_and_read(benchmark::State& state, const Message& message) {
    for (auto _ : state) {
        const Bytes bytes = encode_frame(message);
        benchmark::DoNotOptimize(decode_payload<Message>(parse_frame(bytes)->payload));
    }
    state.SetItemsProcessed(state.iterations());
}

void pvt_written_and_read(benchmark::State& state) {
    NavPvt pvt;
    pvt.vehicle.emplace();
    write_and_read(state, pvt);
}
BENCHMARK(pvt_written_and_read);

void rawx_of_eighty_written_and_read(benchmark::State& state) {
    RxmRawx rawx;
    rawx.measurements.resize(80);
    write_and_read(state, rawx);
}
BENCHMARK(rawx_of_eighty_written_and_read);

}  // namespace
