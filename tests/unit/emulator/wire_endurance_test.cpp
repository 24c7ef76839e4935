// A wire that is pulled in the middle of a run, a thousand times: no epoch is lost, every time bytes come again, and
// neither memory nor descriptors grow.
#include <fcntl.h>
#include <gtest/gtest.h>
#include <malloc.h>
#include <stdlib.h>
#include <unistd.h>

#include <array>
#include <cmath>
#include <functional>

#include "support/run_parts.hpp"
#include "unit/transport/tcp_peer.hpp"
#include "unit/transport/temporary_folder.hpp"
#include "wire/transport/pty.hpp"
#include "wire/transport/rfc2217.hpp"
#include "wire/transport/serial.hpp"

namespace skyloop {
namespace {

namespace fs = std::filesystem;
using namespace std::chrono_literals;

constexpr int pulls_wanted = 1000;
constexpr std::uint64_t most_epochs = 80'000;  // of a run that does not recover; less than a day, so that times ascend

std::string all_of(int descriptor) {
    std::string all;
    std::array<char, 4096> piece{};
    for (ssize_t count = 0; (count = ::read(descriptor, piece.data(), piece.size())) > 0;)
        all.append(piece.data(), static_cast<std::size_t>(count));
    return all;
}

// The other end of a wire, as one that pulls it.
class Puller {
public:
    virtual ~Puller() = default;
    virtual void pull() = 0;
    virtual void put_back() = 0;
    // What has come since it was put back.
    virtual std::string heard() = 0;
};

// A program that is killed and started again.
class KilledPtyClient : public Puller {
public:
    explicit KilledPtyClient(std::string terminal) : terminal_(std::move(terminal)) {}
    void pull() override { client_ = FileDescriptor(); }
    void put_back() override {
        client_ = FileDescriptor(::open(terminal_.c_str(), O_RDWR | O_NOCTTY | O_NONBLOCK | O_CLOEXEC));
        ASSERT_TRUE(client_.open());
    }
    std::string heard() override { return all_of(client_.value()); }

private:
    std::string terminal_;
    FileDescriptor client_;
};

// A connection that ends with a reset.
class ResetTcpClient : public Puller {
public:
    explicit ResetTcpClient(std::uint16_t port) : port_(port) {}
    void pull() override {
        const linger at_once{1, 0};
        ::setsockopt(client_.value(), SOL_SOCKET, SO_LINGER, &at_once, sizeof at_once);
        client_ = FileDescriptor();
    }
    void put_back() override {
        client_ = FileDescriptor(::socket(AF_INET, SOCK_STREAM | SOCK_CLOEXEC, 0));
        const sockaddr_in where = test::TcpPeer::loopback(port_);
        ASSERT_EQ(::connect(client_.value(), reinterpret_cast<const sockaddr*>(&where), sizeof where), 0);
        ASSERT_EQ(::fcntl(client_.value(), F_SETFL, O_NONBLOCK), 0);
    }
    std::string heard() override { return all_of(client_.value()); }

private:
    std::uint16_t port_;
    FileDescriptor client_;
};

// A cable at whose device another terminal appears each time, as a USB adapter gets another number.
class SerialCable : public Puller {
public:
    SerialCable() { plug_in(); }
    [[nodiscard]] fs::path device() const { return folder_ / "ttyUSB"; }
    void pull() override {
        fs::remove(device());
        master_ = FileDescriptor();
    }
    void put_back() override {
        if (!master_.open()) plug_in();
    }
    std::string heard() override { return all_of(master_.value()); }

private:
    void plug_in() {
        master_ = FileDescriptor(::posix_openpt(O_RDWR | O_NOCTTY | O_NONBLOCK | O_CLOEXEC));
        std::array<char, 64> name{};
        ASSERT_EQ(::grantpt(master_.value()) | ::unlockpt(master_.value()), 0);
        ASSERT_EQ(::ptsname_r(master_.value(), name.data(), name.size()), 0);
        fs::create_symlink(name.data(), device());
    }
    test::TemporaryFolder folder_;
    FileDescriptor master_;
};

// A clock that goes a thousand times as fast: what is looked for every half second is looked for every half
// millisecond.
class HastySystem : public SerialSystem {
public:
    std::int64_t now_ns() override { return SerialSystem::now_ns() * 1000; }
};

struct Used {
    std::size_t heap = 0, descriptors = 0;
    long resident_kb = 0;
};

Used used_now() {
    Used used;
    used.heap = ::mallinfo2().uordblks;  // 0 under a sanitizer
    for ([[maybe_unused]] const auto& entry : fs::directory_iterator("/proc/self/fd"))
        ++used.descriptors;
    std::ifstream status("/proc/self/status");
    for (std::string line; std::getline(status, line);)
        if (line.rfind("VmRSS:", 0) == 0) used.resident_kb = std::stol(line.substr(6));
    return used;
}

// One run whose wire is pulled in each second epoch or later, when fresh bytes have been heard since the last time.
class PulledRun {
public:
    PulledRun(std::unique_ptr<Transport> wire, Puller& puller) : puller_(puller) {
        const Scenario scenario = test::emulator_scenario(
            "[run]\nstart = 2024-03-05T00:00:00Z\n[model]\nname = \"ideal\"\n[[receiver]]\nbaud = 38400\n");
        start_ = *scenario.run.start;
        Station::Parts parts = test::station_parts(scenario, 0, start_);
        parts.recorder = std::move(test::recorder_in(folder_ / "run").value());
        parts.wires.push_back({firmware::PortId::uart1, Link(std::move(wire), PortSpeed(38400))});
        std::vector<Station> stations;
        stations.emplace_back(std::move(parts));
        emulator_ = std::make_unique<Emulator>(
            Emulator::Parts{std::move(stations), std::make_unique<test::TickingPacer>(start_, 100ms)}, start_);
        emulator_->on_status([this](const Status& status) { follow(status); });
    }

    void run() {
        emulator_->run_until(GpsTime::max(), stop_);
        EXPECT_EQ(pulls_, pulls_wanted) << "after " << emulator_->counts().epochs << " epochs";
        const auto seconds = static_cast<std::uint64_t>(std::llround(difference(emulator_->now(), start_).value()));
        EXPECT_EQ(emulator_->counts().epochs, seconds + 1) << "no epoch is lost";
        expect_rows(seconds + 1);
        EXPECT_EQ(late_.descriptors, early_.descriptors);
        EXPECT_LT(late_.heap, early_.heap + 65536);
        if (early_.heap > 0) {
            EXPECT_LT(late_.resident_kb, early_.resident_kb + 4096);
        }
    }
    [[nodiscard]] std::size_t news() const { return news_; }

private:
    void follow(const Status& status) {
        news_ += emulator_->stations()[0].transport(0).take_news().size();
        if (emulator_->counts().epochs >= most_epochs) stop_ = true;
        if (!plugged_) {
            puller_.put_back();
            plugged_ = true;
            text_.clear();
            return;
        }
        text_ += puller_.heard();
        if (!heard_fresh(difference(status.now, start_).value())) {
            ::usleep(100);  // simulated time waits for nobody, and the one who plugs in must run
            return;
        }
        if (++pulls_ == pulls_wanted / 10) early_ = used_now();
        if (pulls_ == pulls_wanted) {
            late_ = used_now();
            stop_ = true;
            return;
        }
        puller_.pull();
        plugged_ = false;
        pulled_at_ = difference(status.now, start_).value();
    }

    // A sentence of an epoch since the wire was pulled; one of before would be stale.
    bool heard_fresh(double now) {
        const std::size_t at = text_.find("GGA,");
        const std::size_t point = at == std::string::npos ? at : text_.find('.', at);
        if (point == std::string::npos || point < at + 10) return false;
        const int clock = std::stoi(text_.substr(at + 4, 6));  // hhmmss of UTC; the run starts at midnight
        const double second = clock / 10000 * 3600 + clock / 100 % 100 * 60 + clock % 100;
        EXPECT_GE(second, pulled_at_) << "stale bytes";
        EXPECT_LE(second, now);
        return true;
    }

    // Each epoch once: the time of week goes up by a second from row to row.
    void expect_rows(std::uint64_t epochs) const {
        const auto rows = test::lines_of(test::content_of(folder_ / "run/fixes.csv"));
        ASSERT_EQ(rows.size(), epochs + 1);
        const double first = std::stod(test::cells_of(rows[1]).at(2));
        for (std::size_t i = 1; i < rows.size(); ++i)
            ASSERT_NEAR(std::stod(test::cells_of(rows[i]).at(2)), first + static_cast<double>(i - 1), 1e-6);
    }

    Puller& puller_;
    test::TemporaryFolder folder_;
    GpsTime start_;
    std::unique_ptr<Emulator> emulator_;
    std::atomic<bool> stop_{false};
    bool plugged_ = false;
    int pulls_ = 0;
    double pulled_at_ = 0;
    std::string text_;
    std::size_t news_ = 0;
    Used early_, late_;
};

TEST(WireEndurance, PtyClientKilledAThousandTimes) {
    auto wire = PtyTransport::open().value();
    KilledPtyClient client(wire->terminal());
    PulledRun(std::move(wire), client).run();
}

TEST(WireEndurance, TcpConnectionResetAThousandTimes) {
    auto wire = TcpTransport::listen({}).value();
    ResetTcpClient client(wire->port());
    PulledRun(std::move(wire), client).run();
}

TEST(WireEndurance, Rfc2217ConnectionResetAThousandTimes) {
    auto wire = Rfc2217Transport::listen({}).value();
    ResetTcpClient client(wire->port());
    PulledRun(std::move(wire), client).run();
}

TEST(WireEndurance, SerialCablePulledAThousandTimes) {
    SerialCable cable;
    auto wire = SerialTransport::open({cable.device(), std::nullopt, {}}, std::make_shared<HastySystem>()).value();
    PulledRun run(std::move(wire), cable);
    run.run();
    // Gone and back, each told; and at the first look the cable was in.
    EXPECT_GE(run.news(), 2U * (pulls_wanted - 1));
}

}  // namespace
}  // namespace skyloop
