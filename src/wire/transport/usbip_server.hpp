/// A USB receiver for other machines: a USB/IP server whose one device a Linux kernel attaches as /dev/ttyACM0.
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "base/core/result.hpp"
#include "wire/transport/cdc_acm_device.hpp"
#include "wire/transport/tcp.hpp"
#include "wire/transport/transport.hpp"
#include "wire/transport/usbip_session.hpp"

namespace skyloop::inline wire {

class TcpListener;

/// A virtual USB receiver that one client at a time imports, over USB/IP.
///
/// It is connected while the importing host polls its data endpoint, which it does as long as a program has the
/// terminal open (UsbipSession says when that ends). Anybody may have the device listed at any time. Closing the
/// connection is pulling the plug, from either end. USB/IP knows no authentication: off the loopback address
/// take_news() warns.
///
/// All that happens in the calls of the loop; none waits. Whoever breaks the rules of USB/IP is closed, and take_news()
/// says why.
class UsbipTransport : public Transport {
public:
    /// Fails with `outside` when the host is unknown or the system refuses. A host name may take its time to look up.
    static Result<std::unique_ptr<UsbipTransport>> listen(const TcpAddress& address, const UsbFace& face = {});
    ~UsbipTransport() override;
    UsbipTransport(const UsbipTransport&) = delete;
    UsbipTransport& operator=(const UsbipTransport&) = delete;

    std::size_t write(ByteSpan bytes) override;
    Bytes read() override;
    /// The speed is that of the host's line coding, once it has set one.
    LineState line() override;
    /// Unplugged, it ends the import and is neither listed nor imported.
    void set_plugged(bool plugged) override;
    std::vector<std::string> take_news() override;
    /// "attached by 10.0.0.7:51022, 115200 8N1, DTR, RTS".
    [[nodiscard]] std::string other_end() const override;
    /// "127.0.0.1:3240 (usbip)".
    [[nodiscard]] std::string description() const override;

    /// Where it listens; never 0.
    [[nodiscard]] std::uint16_t port() const;
    /// How often it was imported.
    [[nodiscard]] std::uint64_t imports() const { return imports_; }

private:
    struct Visitor;   // has asked for nothing yet, or is being answered
    struct Importer;  // has imported the device

    UsbipTransport(TcpListener listener, UsbFace face);
    void follow();
    void accept_visitors(std::int64_t now_ns);
    bool make_room();
    bool serve(Visitor& visitor, std::int64_t now_ns);
    bool answer_request(Visitor& visitor);
    void import_by(Visitor& visitor);
    void follow_importer(std::int64_t now_ns);
    void end_import(const std::string& how);
    void tell(std::string news);
    [[nodiscard]] UsbipDevice listed() const;

    std::unique_ptr<TcpListener> listener_;
    UsbFace face_;
    std::vector<std::unique_ptr<Visitor>> visitors_;
    std::unique_ptr<Importer> importer_;
    Bytes received_;  // of an importer that has gone
    bool plugged_ = true;
    std::uint64_t imports_ = 0;
    std::vector<std::string> news_;
    std::uint64_t untold_ = 0;
};

}  // namespace skyloop::inline wire
